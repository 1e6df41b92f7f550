#include <algorithm>

#include "globe/globe_impl.h"

// The instants of image layers: one of a layer is shown, later ones are on their way.
namespace terrella {
namespace {

/// Layers that may be on their way to one place. Each takes its share of the GPU's memory.
constexpr std::size_t kMostComing = 3;
/// Earlier instants that are tried in place of one without a tile in view. In polar night every one is missing.
constexpr int kMostStepsBack = 3;
constexpr std::size_t kMostMissingInstants = 64;

std::optional<UtcTime> instant_of(const ImageLayer& layer) { return layer.source()->info().instant; }

}  // namespace

ImageLayer* Globe::Impl::newest_coming(const ImageLayer& shown) const {
  ImageLayer* newest = nullptr;
  for (const auto& layer : coming) {
    const bool is_later = layer && layer->id() == shown.id() && layer->turn().number > shown.turn().number;
    if (is_later && (newest == nullptr || layer->turn().number > newest->turn().number)) newest = layer.get();
  }
  return newest;
}

Status Globe::Impl::has_own_clock(const char* call, const ImageLayer& layer) const {
  if (!follows_clock(layer)) return Done{};
  return Error{std::string(call) +
               ": the layer follows the globe's time; call Globe::set_time(), or give ImageLook::clock own"};
}

bool Globe::Impl::is_late(const ImageLayer& layer) const {
  const ImageLayer* shown = image(layer.id());
  if (shown == nullptr || shown == &layer || layer.turn().is_ahead) return false;
  return layer.turn().number < shown->turn().number;
}

void Globe::Impl::drop_late(LayerId id) {
  const auto is_for = [id](const auto& layer) { return layer->id() == id; };
  while (static_cast<std::size_t>(std::ranges::count_if(coming, is_for)) > kMostComing) {
    auto oldest = coming.end();
    for (auto layer = coming.begin(); layer != coming.end(); ++layer) {
      if (!is_for(*layer) || (*layer)->turn().is_ahead) continue;
      if (oldest == coming.end() || (*layer)->turn().number < (*oldest)->turn().number) oldest = layer;
    }
    forget_views_of(**oldest);
    coming.erase(oldest);
  }
}

Status Globe::Impl::ask_for_time(const ImageLayer& shown, UtcTime time, const SourceTurn& turn) {
  const char* call = turn.is_ahead ? "Globe::load_layer_time" : "Globe::set_layer_time";
  auto source = shown.source()->at_time(time);
  if (!source) return Error{std::string(call) + ": " + source.error().message};
  auto layer = make_image(call, shown.id(), *std::move(source), shown.look());
  if (!layer) return layer.error();
  (*layer)->set_turn(turn);
  (*layer)->set_attribution(shown.attribution());
  coming.push_back(*std::move(layer));
  for (GlobeView::Impl* view : views) view->is_behind = true;
  drop_late(shown.id());
  share_gpu();
  return Done{};
}

ImageLayer* Globe::Impl::coming_at(const ImageLayer& shown, UtcTime step) const {
  const auto known = std::ranges::find_if(coming, [&](const auto& layer) {
    return layer->id() == shown.id() && instant_of(*layer) == std::optional(step);
  });
  return known == coming.end() ? nullptr : known->get();
}

Status Globe::Impl::ask_for_step(const ImageLayer& shown, UtcTime step, const SourceTurn& turn) {
  ImageLayer* known = coming_at(shown, step);
  if (known == nullptr) return ask_for_time(shown, step, turn);
  known->set_turn(turn);
  return Done{};
}

Status Globe::Impl::go_to_time(ImageLayer& shown, UtcTime time) {
  const SourceTurn turn{.number = turns + 1};
  const TileSetInfo& info = shown.source()->info();
  const std::optional<UtcTime> found = info.steps ? info.steps->at_or_before(time) : std::nullopt;
  if (!found) return ask_for_time(shown, time, turn);  // the source says what is wrong
  const UtcTime step = *found;
  const auto is_there = [&](const ImageLayer& layer) { return instant_of(layer) == std::optional(step); };
  const ImageLayer* newest = newest_coming(shown);
  if (is_there(newest == nullptr ? shown : *newest)) return Done{};
  if (is_there(shown)) {
    shown.set_turn(turn);
  } else if (Status asked = ask_for_step(shown, step, turn); !asked) {
    return asked;
  }
  turns = turn.number;
  changed = true;
  return Done{};
}

Status Globe::Impl::load_ahead(const ImageLayer& shown, UtcTime time) {
  const TileSetInfo& info = shown.source()->info();
  const std::optional<UtcTime> step = info.steps ? info.steps->at_or_before(time) : std::nullopt;
  if (step && (instant_of(shown) == step || coming_at(shown, *step) != nullptr)) return Done{};
  drop_coming(shown.id(), Coming::ahead);
  changed = true;
  return ask_for_time(shown, time, {.is_ahead = true});
}

void Globe::Impl::note_missing(const ImageLayer& lacking, UtcTime instant) {
  const auto tile = std::ranges::find(missing.rbegin(), missing.rend(), lacking.id(), &MissingTile::layer);
  note_missing(lacking.id(), instant, tile == missing.rend() ? "" : tile->failure.why);
}

void Globe::Impl::note_missing(LayerId layer, UtcTime instant, std::string why) {
  missing_instants.push_back({layer, instant, std::move(why)});
  if (missing_instants.size() > kMostMissingInstants) missing_instants.pop_front();
}

void Globe::Impl::step_back(const ImageLayer& lacking) {
  const TileSetInfo& info = lacking.source()->info();
  const ImageLayer* shown = image(lacking.id());
  if (!info.steps || !info.instant || shown == nullptr) return;
  note_missing(lacking, *info.instant);
  const SourceTurn turn{.number = lacking.turn().number, .steps_back = lacking.turn().steps_back + 1};
  const ImageLayer* newest = newest_coming(*shown);
  const bool is_wanted = turn.number > std::max(shown->turn().number, newest == nullptr ? 0 : newest->turn().number);
  const auto earlier = info.steps->at_or_before(*info.instant - std::chrono::milliseconds(1));
  if (!is_wanted || !earlier || turn.steps_back > kMostStepsBack) return;
  if (instant_of(*shown) == std::optional(*earlier)) return;
  // A source that cannot be made leaves the layer as it is: the missing instant is named.
  static_cast<void>(ask_for_step(*shown, *earlier, turn));
}

Status Globe::set_layer_time(LayerId imagery, UtcTime time) {
  const auto call = impl_->may_draw("Globe::set_layer_time");
  if (!call) return call.error();
  ImageLayer* shown = impl_->image(imagery);
  if (shown == nullptr) return no_layer("Globe::set_layer_time", "image layer", imagery);
  if (Status own = impl_->has_own_clock("Globe::set_layer_time", *shown); !own) return own;
  if (Status gone = impl_->go_to_time(*shown, time); !gone) return gone;
  impl_->put_in_place();
  return Done{};
}

Status Globe::load_layer_time(LayerId imagery, std::optional<UtcTime> time) {
  const auto call = impl_->may_draw("Globe::load_layer_time");
  if (!call) return call.error();
  const ImageLayer* shown = impl_->image(imagery);
  if (shown == nullptr) return no_layer("Globe::load_layer_time", "image layer", imagery);
  if (Status own = impl_->has_own_clock("Globe::load_layer_time", *shown); !own) return own;
  if (time) return impl_->load_ahead(*shown, *time);
  impl_->drop_coming(imagery, Impl::Coming::ahead);
  return Done{};
}

Result<LayerTime> Globe::layer_time(LayerId imagery) const {
  if (Status call = impl_->may_call("Globe::layer_time"); !call) return call.error();
  const ImageLayer* shown = impl_->image(imagery);
  if (shown == nullptr) return no_layer("Globe::layer_time", "image layer", imagery);
  const ImageLayer* newest = impl_->newest_coming(*shown);
  const auto [next, share] = impl_->fade_of(*shown);
  return LayerTime{.shown = shown->is_early() ? std::nullopt : instant_of(*shown),
                   .next = next == nullptr ? std::nullopt : instant_of(*next),
                   .next_share = share,
                   .coming = newest == nullptr ? std::nullopt : instant_of(*newest)};
}

const std::deque<MissingInstant>& Globe::missing_instants() const {
  static const std::deque<MissingInstant> none;
  return impl_->may_call("Globe::missing_instants") ? impl_->missing_instants : none;
}

}  // namespace terrella
