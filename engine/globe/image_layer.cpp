#include "globe/image_layer.h"

#include <algorithm>
#include <cmath>

#include "geo/longitudes.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

constexpr int kMips = 4;
constexpr TileGrid kPlainGrid{.tile_px = 16};

// The other texturing methods exist for comparison, so they draw the full grid, as every tool does.
TileGrid grid_to_draw(const GlobeOptions& options, TileGrid grid) {
  const bool polar_program = options.texturing == Texturing::exact || options.texturing == Texturing::automatic;
  grid.reduced = grid.reduced && options.squeezed_rows && polar_program;
  return grid;
}

SlotLayout layout_of(const GlobeOptions& options, const TileGrid& grid, const TileSource* source) {
  SlotLayout layout{.tile_px = grid.tile_px, .gutter_px = options.gutter_px};
  if (source != nullptr && source->info().numbers) layout.numbers = number_slots(*source->info().numbers);
  return layout;
}

}  // namespace

ImageLayer::ImageLayer(LayerId id, const LayerSetup& setup, std::shared_ptr<TileSource> source, const ImageLook& look,
                       std::size_t gpu_bytes)
    : id_(id),
      ellipsoid_(setup.options.body.ellipsoid),
      segments_(setup.options.segments),
      mapping_(setup.mapping),
      texels_per_pixel_(setup.options.texels_per_pixel),
      grid_(source ? grid_to_draw(setup.options, source->info().grid) : kPlainGrid),
      roots_(root_tiles(grid_)),
      look_(look),
      attribution_(source ? source->info().attribution : ""),
      tiles_(grid_, layout_of(setup.options, grid_, source.get()), kMips, gpu_bytes),
      source_(std::move(source)),
      retry_after_(setup.options.retry_after) {
  if (!source_) return;
  if (const auto& slots = tiles_.layout().numbers) numbers_.emplace(*source_->info().numbers, *slots);
  const int workers = setup.options.workers > 0 ? setup.options.workers : decoder_threads();
  loading_ = {.workers = workers, .gutter = setup.options.gutter_px, .mips = kMips, .bell = setup.bell};
  // Tiles waiting for slots hold at most as many bytes as all slots.
  loading_.max_finished_bytes =
      std::min(loading_.max_finished_bytes, static_cast<std::size_t>(tiles_.capacity()) * tiles_.slot_bytes());
  start_stream();
}

void ImageLayer::start_stream() {
  stream_.emplace(TileLoader(source_, loading_), tiles_.residency(), id_, retry_after_);
}

void ImageLayer::invalidate(const std::optional<TileId>& tile) {
  for (auto& [id, entry] : tiles_.residency().entries()) {
    if (tile && id != *tile) continue;
    if (entry.state == TileState::missing) entry.state = TileState::unknown;
    entry.is_outdated = entry.state == TileState::resident;
  }
  was_invalidated_ = true;
  tile ? stream_->reread(*tile) : start_stream();
}

void ImageLayer::forget_tiles() {
  tiles_.forget_tiles();
  has_transparency_ = false;
  start_stream();
  restore_detail();
}

std::unique_ptr<ImageLayer> ImageLayer::make_plain(const LayerSetup& setup) {
  auto plain = std::make_unique<ImageLayer>(LayerId::none, setup, nullptr, ImageLook{}, 0);
  // The tiles of the plain colour are all resident, and empty.
  for (const TileId& id : plain->roots_) {
    TileResidency::Entry& entry = plain->tiles_.residency().entry(id);
    entry.state = TileState::resident;
    entry.slot = 0;
  }
  return plain;
}

// Other colours of the same numbers need no other tiles.
void ImageLayer::set_look(const ImageLook& look) {
  const std::optional<NumberLook> colored = std::exchange(look_.numbers, look.numbers);
  if (look_ != look) restore_detail();
  look_ = look;
}

bool ImageLayer::is_ready() const {
  // Tiles that are still asked for, such as the root tiles, would be dropped if the next instant came before them.
  return !views_.empty() &&
         std::ranges::all_of(views_, [](const auto& view) { return view->settled() && view->requests().empty(); });
}

bool ImageLayer::is_void() const {
  const auto shows = [](const auto& view) { return view->is_on_screen(); };
  return std::ranges::none_of(views_, shows) &&
         std::ranges::any_of(views_, [](const auto& view) { return view->coverage().missing > 0; });
}

bool ImageLayer::is_outdated(const TileId& id, const TileResidency::Entry& entry) const {
  return entry.is_outdated || (entry.edition < source_->edition() && entry.edition < source_->edition_of(id));
}

LayerView& ImageLayer::seen_by(ViewId view) {
  const auto found = std::ranges::find_if(views_, [view](const auto& seen) { return seen->view() == view; });
  if (found != views_.end()) return **found;
  return *views_.emplace_back(std::make_unique<LayerView>(*this, view));
}

void ImageLayer::forget(ViewId view) {
  if (std::erase_if(views_, [view](const auto& seen) { return seen->view() == view; }) > 0) restore_detail();
}

void ImageLayer::discard_patches() {
  vertices_.reset();
  for (const auto& view : views_) view->discard_patches();
}

void ImageLayer::restore_detail() {
  for (const auto& view : views_) view->restore_detail();
}

std::unique_ptr<PatchTree> ImageLayer::make_tree() const {
  return std::make_unique<PatchTree>(ellipsoid_, grid_, segments_, mapping_);
}

// Slot 0 and the slots of root tiles are never evicted. A tenth of the others stays free for tiles in flight.
int ImageLayer::room_for(const LayerView& view) const {
  const int all = (tiles_.capacity() - 1 - static_cast<int>(roots_.size())) * 9 / 10;
  int others = 0, sharing = 1;
  for (const auto& other : views_) {
    if (other.get() == &view || other->coverage().tiles == 0) continue;
    others += other->coverage().tiles;
    ++sharing;
  }
  return std::max(all - others, all / sharing);
}

bool ImageLayer::is_crowded(const LayerView& view) const {
  return views_.size() > 1 && view.coverage().tiles > room_for(view);
}

void ImageLayer::request(const LayerView& asking) {
  if (views_.size() == 1) return stream_->request(asking.requests());
  std::vector<TileRequest> all = asking.requests();
  for (const auto& view : views_) {
    if (view.get() == &asking) continue;
    for (const TileRequest& request : view->requests()) {
      const TileResidency::Entry* entry = tiles_.residency().find(request.id);
      const bool is_there = entry != nullptr && entry->state != TileState::unknown;
      if (!is_there || (entry->state == TileState::resident && is_outdated(request.id, *entry))) all.push_back(request);
    }
  }
  stream_->request(all);
}

bool ImageLayer::is_drawn(const PictureSides& sides) const {
  return look_.shown && look_.opacity > 0.0 && (sides.night || look_.daylight != Daylight::night);
}

bool ImageLayer::is_opaque(const PictureSides& sides) const {
  // A base layer of numbers shows the plain colour where it has none.
  const bool covers = has_numbers() || !has_transparency_;
  return opacity() >= 1.0 && look_.min_level <= grid_.min_level && covers && !is_special(sides);
}

bool ImageLayer::hides(const PictureSides& sides) const {
  return opacity() >= 1.0 && !has_transparency_ && look_.blend == LayerBlend::normal && !is_special(sides);
}

bool ImageLayer::is_see_through() const {
  const auto is_clear = [](const ColorStop& stop) { return stop.color.a < 255; };
  const bool has_clear_colors = look_.numbers && std::ranges::any_of(look_.numbers->colors.stops, is_clear);
  return has_transparency_ || has_clear_colors || look_.alpha == AlphaFrom::brightness;
}

bool ImageLayer::is_special(const PictureSides& sides) const {
  return look_.alpha == AlphaFrom::brightness || look_.height_m > 0.0 ||
         (sides.night && look_.daylight != Daylight::both) || (sides.swipe && look_.swipe != SwipeSide::both) ||
         look_.tone != ImageTone{};
}

// An upload evicts tiles that no view needs. A view that takes more than its room is not spared.
void ImageLayer::keep_tiles_of_views(std::size_t uploads, std::uint64_t frame) {
  if (views_.size() < 2 || tiles_.free_slots() > static_cast<int>(uploads)) return;
  for (const auto& view : views_) {
    if (!is_crowded(*view)) view->keep_tiles(frame - 1);
  }
}

std::size_t ImageLayer::take_finished(UploadAllowance& allowance, std::uint64_t frame,
                                      std::deque<MissingTile>& missing) {
  std::size_t bytes = 0;
  if (!stream_) return bytes;
  stream_->retry();
  keep_tiles_of_views(allowance.bytes / tiles_.slot_bytes() + 1, frame);
  while (allowance.bytes > 0) {
    const std::optional<LoadedTile> loaded = stream_->take(missing);
    if (!loaded) break;
    const TileTexels& texels = *loaded->tile;
    has_transparency_ = has_transparency_ || !texels.opaque;
    if (tiles_.upload(loaded->id, texels.mips, frame)) {
      TileResidency::Entry& entry = tiles_.residency().entry(loaded->id);
      entry.edition = loaded->edition;
      entry.is_outdated = false;
      bytes += tiles_.slot_bytes();
      allowance.bytes -= std::min(tiles_.slot_bytes(), allowance.bytes);
    }
    if (std::chrono::steady_clock::now() > allowance.deadline) allowance.bytes = 0;
  }
  return bytes;
}

void ImageLayer::end_frame(LayerView& view, std::uint64_t frame) {
  view.tree().end_frame();
  tiles_.residency().end_frame(frame, grid_.min_level);
}

void ImageLayer::stop_asking() {
  for (const auto& view : views_) view->stop_asking();
  if (stream_) stream_->stop();
}

std::optional<LayerValue> ImageLayer::value_at(const Geodetic& place) const {
  const double row_deg = row_latitude_deg(grid_, ellipsoid_, Ellipsoid::normal(place.lat, place.lon));
  const double lon_deg = -180.0 + std::fmod(degrees_east(place.lon.deg(), -180.0), 360.0);
  for (int level = grid_.max_level; level >= grid_.min_level; --level) {
    const TileXY at = tile_xy(grid_, level, row_deg, lon_deg);
    const TileId full{.level = level,
                      .x = static_cast<std::int64_t>(std::floor(at.x)),
                      .y = std::min(static_cast<std::int64_t>(std::floor(at.y)), rows(grid_, level) - 1)};
    const TileId id = reduced_tile(grid_, full);
    const TileResidency::Entry* entry = tiles_.residency().find(id);
    if (entry == nullptr || entry->state != TileState::resident) continue;
    const auto texel = [this](double part) {
      return std::clamp(static_cast<int>(part * grid_.tile_px), 0, grid_.tile_px - 1);
    };
    const double number = tiles_.number_at(id, texel(std::ldexp(at.x, -id.squeeze) - static_cast<double>(id.x)),
                                           texel(at.y - static_cast<double>(id.y)));
    const NumberInfo& info = numbers_->info();
    return LayerValue{.value = number * info.scale + info.offset, .level = level};
  }
  return std::nullopt;
}

}  // namespace terrella
