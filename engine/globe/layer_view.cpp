#include "globe/layer_view.h"

#include <algorithm>

#include "globe/image_layer.h"

namespace terrella {
namespace {

/// Priority of drawn tiles that have a better edition: after all tiles that are not there.
constexpr double kRenewal = -1e9;

}  // namespace

bool LayerView::has_tiles(std::size_t patch) const { return std::ranges::any_of(cells_of(coverage_, patch), has_tile); }
bool LayerView::is_full(std::size_t patch) const { return std::ranges::all_of(cells_of(coverage_, patch), has_tile); }

void LayerView::discard_patches() {
  patches_.clear();
  tree_ = layer_.make_tree();
}

LayerSnapshot LayerView::snapshot() {
  const ImageLook& look = layer_.look();
  LayerSnapshot layer{.tree = tree_.get(),
                      .tiles = &layer_.tiles().residency(),
                      .texels_per_pixel = layer_.texels_per_pixel(),
                      .detail = detail_,
                      .max_tile_level = look.max_level,
                      .daylight = look.daylight,
                      .height_m = look.height_m};
  if (layer_.stream()) layer.room = room_ = layer_.room_for(*this);
  if (look.min_level > layer_.grid().min_level) layer.least_level = look.min_level;
  return layer;
}

void LayerView::execute(LayerPlan& plan, std::uint64_t frame) {
  tree_->adopt(plan.growth);
  std::swap(patches_, plan.patches);
  std::swap(coverage_, plan.coverage);
  detail_ = plan.detail;
  frame_ = frame;
  coverage_.uses.note(frame, layer_.tiles().residency());
}

void LayerView::copy_relief() {
  for (const SelectedPatch& patch : patches_) PatchTree::copy_relief(*patch.surface, *patch.node);
}

// Root tiles come first: an ancestor for everything.
void LayerView::ask() {
  if (!layer_.stream()) return;
  requests_.clear();
  TileResidency& tiles = layer_.tiles().residency();
  for (const TileId& id : layer_.roots()) {
    if (tiles.entry(id).state == TileState::unknown) requests_.push_back({id, 1e9});
  }
  for (const WantedTile& wanted : coverage_.wanted) requests_.push_back({wanted.id, wanted.priority});
  edition_ = layer_.source()->edition();
  outdated_drawn_ = 0;
  if (edition_ > 0 || layer_.was_invalidated()) add_outdated();
  seen_ = layer_.stream()->taken();
  layer_.request(*this);
}

void LayerView::add_outdated() {
  for (const auto& [id, entry] : layer_.tiles().residency().entries()) {
    if (entry.state != TileState::resident || entry.last_drawn < frame_) continue;
    if (entry.is_outdated) ++outdated_drawn_;
    if (layer_.is_outdated(id, entry)) requests_.push_back({id, kRenewal});
  }
}

void LayerView::keep_tiles(std::uint64_t frame) const {
  for (const TileUse& use : coverage_.uses.all()) {
    if (!use.needed) continue;
    TileResidency::Entry* entry = layer_.tiles().residency().find(use.id);
    if (entry != nullptr) entry->last_needed = std::max(entry->last_needed, frame);
  }
}

LayerFrame LayerView::frame(bool is_base, const PictureSides& sides) {
  const ImageLook& look = layer_.look();
  NumberColors* numbers = layer_.numbers();
  if (numbers != nullptr) numbers->set(*look.numbers);
  gpu_.numbers = numbers;
  hides_ = layer_.hides(sides);
  layer_.tiles().set_empty(is_base ? TileTextures::Empty::plain_colour : TileTextures::Empty::transparent);
  return {.tree = tree_.get(),
          .patches = &patches_,
          .coverage = &coverage_,
          .tiles = &layer_.tiles(),
          .gpu = &gpu_,
          .vertices = &layer_.vertices(),
          .opacity = is_base ? 1.0 : layer_.opacity(),
          .daylight = sides.night ? look.daylight : Daylight::both,
          .alpha = look.alpha,
          .swipe = sides.swipe ? look.swipe : SwipeSide::both,
          .blend = is_base ? LayerBlend::normal : look.blend,
          .tone = look.tone,
          .unlit = numbers != nullptr && !look.numbers->lit,
          .height_m = is_base ? 0.0 : look.height_m,
          .special = layer_.is_special(sides),
          .hides = hides_ && numbers == nullptr};
}

// Patches of a root tile that has finally failed can never be covered, so nothing waits for them.
bool LayerView::settled() const {
  if (!layer_.stream()) return true;
  if (!coverage_.wanted.empty() || outdated_drawn_ > 0) return false;
  if (coverage_.uncovered == 0) return true;
  return std::ranges::none_of(layer_.roots(), [&](const TileId& id) {
    return layer_.tiles().residency().entry(id).state == TileState::unknown;
  });
}

bool LayerView::has_news() const {
  if (!layer_.stream()) return false;
  return layer_.stream()->has_news(seen_, !requests_.empty()) || layer_.source()->edition() != edition_ ||
         (layer_.is_crowded(*this) && layer_.room_for(*this) < room_);
}

}  // namespace terrella
