#include "apps/viewer/feature_list/feature_list.h"

#include <algorithm>
#include <chrono>

#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr int kFittingFrames = 2;             // after a change of the rows
constexpr std::size_t kRowsInFrame = 20'000;  // searched in some milliseconds

template <class Value>
bool has_come(const std::future<Value>& value) {
  return value.valid() && value.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

void FeatureList::open(ListedLayer layer) {
  const bool other = layer.id != layer_.id;
  layer_ = std::move(layer);
  if (other) read_features();
  if (panel() != nullptr) toggle();
  toggle();
}

void FeatureList::read_features() {
  reading_.cancel();
  reading_field_.cancel();
  table_.reset();
  column_.reset();
  field_.clear();
  sort_ = {};
  reading_.stop = {};
  reading_.value = std::async(std::launch::async, [features = layer_.features, stop = reading_.stop.get_token()] {
    return read_table(*features, stop);
  });
}

void FeatureList::read_field(const std::string& field) {
  reading_field_.cancel();
  column_.reset();
  field_ = field;
  sort_ = {};
  search_again();
  if (field.empty()) return;
  reading_field_.stop = {};
  reading_field_.value =
      std::async(std::launch::async, [features = layer_.features, field, stop = reading_field_.stop.get_token()] {
        return read_column(*features, field, stop);
      });
}

void FeatureList::take_work() {
  if (has_come(reading_.value)) {
    table_ = reading_.value.get();
    search_again();
  }
  if (has_come(reading_field_.value)) {
    column_ = reading_field_.value.get();
    if (sort_.by_field) search_again();
  }
}

const SortOrder& FeatureList::order() const { return sort_.by_field && column_ ? column_->order : table_->by_name; }

void FeatureList::search_again() {
  if (table_) filter_.begin(order(), sort_.descending, text_);
}

std::string FeatureList::job() const {
  const bool reads = reading_.value.valid() || reading_field_.value.valid();
  return reads && panel() != nullptr ? "Reading the features of " + layer_.name : std::string();
}

bool FeatureList::changed() const {
  if (panel() == nullptr) return false;
  return has_come(reading_.value) || has_come(reading_field_.value) || filter_.is_busy() || frames_ > 0;
}

void FeatureList::toggled() {
  text_.clear();
  search_again();
  reveal_ = is_open();
  if (!is_open()) context_.ui.expect_text(false);
}

void FeatureList::take_keyboard() {
  Panel::take_keyboard();
  context_.ui.expect_text(true);
}

// The list closes with its layer.
void FeatureList::draw(float foot) {
  if (layer_.id != LayerId::none && !asks_.has_layer(layer_.id)) {
    cover(false);
    close();
    reading_.cancel();
    reading_field_.cancel();
    layer_ = {};
    table_.reset();
    column_.reset();
  }
  Panel::draw(foot);
}

void FeatureList::draw_open(float foot) {
  take_work();
  frames_ = std::max(0, frames_ - 1);
  if (filter_.is_busy()) frames_ = kFittingFrames;
  if (table_) filter_.step(*table_, kRowsInFrame);
  const ListContents contents{.layer = layer_.name,
                              .table = table_ ? &*table_ : nullptr,
                              .field = field_,
                              .column = column_ ? &*column_ : nullptr,
                              .found = filter_.found(),
                              .selected = selected(),
                              .reveal = std::exchange(reveal_, false),
                              .takes_keyboard = table_ && take_just_opened()};
  const ListWish wish = draw_feature_list(panel(), contents, text_, foot);
  if (wish.typing) context_.ui.field_is_ready();
  if (table_) answer(wish);
}

std::optional<std::uint32_t> FeatureList::selected() const {
  const ObjectId id = asks_.chosen(layer_.id);
  const auto at =
      std::ranges::lower_bound(*layer_.features, id, {}, [](const ListedFeature& one) { return one.of.id; });
  if (at == layer_.features->end() || at->of.id != id) return {};
  return static_cast<std::uint32_t>(at - layer_.features->begin());
}

void FeatureList::answer(const ListWish& wish) {
  if (wish.field) read_field(*wish.field);
  if (wish.sort && *wish.sort != sort_) {
    sort_ = *wish.sort;
    search_again();
    reveal_ = true;
  }
  if (wish.filtered) filter_.narrow(order(), sort_.descending, text_);
  if (wish.step != 0) move_by(wish.step);
  if (wish.entered) enter();
  if (!wish.clicked) return;
  selected() == wish.clicked ? asks_.fly() : choose(*wish.clicked);
  take_keyboard();
}

void FeatureList::choose(std::uint32_t row) { asks_.choose(layer_.id, (*layer_.features)[row]); }

void FeatureList::move_by(int step) {
  const std::vector<std::uint32_t>& found = filter_.found();
  if (found.empty()) return;
  const auto row = selected();
  const auto at = row ? std::ranges::find(found, *row) : found.end();
  const auto last = static_cast<std::ptrdiff_t>(found.size()) - 1;
  const std::ptrdiff_t next = at == found.end() ? 0 : std::clamp<std::ptrdiff_t>(at - found.begin() + step, 0, last);
  if (at == found.end() || next != at - found.begin()) choose(found[std::size_t(next)]);
  reveal_ = true;
}

// Enter takes the selected row, or the first one as the search for places does.
void FeatureList::enter() {
  while (!filter_.step(*table_, kRowsInFrame) && filter_.is_busy()) {
  }
  const std::vector<std::uint32_t>& found = filter_.found();
  const auto row = selected();
  const bool listed = row && std::ranges::find(found, *row) != found.end();
  if (!listed && !found.empty()) choose(found.front());
  if (!found.empty()) asks_.fly();
  reveal_ = true;
  take_keyboard();
}

}  // namespace terrella
