#include <fmt/format.h>

#include <algorithm>

#include "base/range_check.h"
#include "globe/globe_impl.h"
#include "tiles/grid_ranges.h"
#include "tiles/tile_range.h"

// The image layers and the heights of a globe, and the state that all layers share.
namespace terrella {
namespace {

// The projections of tiles as stored are never drawn.
Status check_source(const TileSetInfo& info) {
  const TileGrid& grid = info.grid;
  const Projection projection = grid.projection;
  const Status good = check_grid(grid, "grid");
  return RangeCheck()
      .that(projection == Projection::equirectangular || projection == Projection::equal_area,
            "its tiles are in a projection that is not drawn; open the set by open_tile_set()")
      .part("its description is wrong", good)
      .part("its grid", good ? check_root_tiles(grid) : Done{})
      .part("its numbers", info.numbers ? check_numbers(*info.numbers) : Status(Done{}))
      .result();
}

/// A layer of numbers needs a stretch and a colour map, a layer of pictures has none.
Status check_look(bool has_numbers, const ImageLook& look) {
  return RangeCheck()
      .that(!has_numbers || look.numbers,
            "the tiles are numbers; give their stretch and colour map (ImageLook::numbers)")
      .that(has_numbers || !look.numbers,
            "the tiles are pictures, which have no stretch; leave ImageLook::numbers empty")
      .part("the look", check_look(look))
      .result();
}

}  // namespace

Error no_layer(const char* call, const char* kind, LayerId id) {
  return Error{fmt::format("{}: the globe has no {} {} (removed before, or another globe's)", call, kind,
                           static_cast<std::uint64_t>(id))};
}

ImageLayer* Globe::Impl::image(LayerId id) const {
  const auto found = std::ranges::find_if(images, [id](const auto& layer) { return layer->id() == id; });
  return found == images.end() ? nullptr : found->get();
}

std::vector<ImageLayer*> Globe::Impl::all_images() const {
  std::vector<ImageLayer*> all;
  for (const auto& layer : images) all.push_back(layer.get());
  for (const auto& layer : coming) all.push_back(layer.get());
  return all;
}

void Globe::Impl::share_gpu() {
  const std::vector<ImageLayer*> all = all_images();
  for (ImageLayer* layer : all) layer->set_gpu_bytes(options.gpu_bytes / all.size());
}

Result<std::unique_ptr<ImageLayer>> Globe::Impl::make_image(const char* call, LayerId id,
                                                            std::shared_ptr<TileSource> source, const ImageLook& look) {
  if (!source) {
    return Error{
        fmt::format("{}: there is no source; open one first (open_tile_set()), or give painted_tiles() a "
                    "function",
                    call)};
  }
  if (Status good = check_source(source->info()); !good) {
    return refusal((std::string(call) + ": the source").c_str(), good);
  }
  if (Status good = check_look(source->info().numbers.has_value(), look); !good) return refusal(call, good);
  const std::vector<ImageLayer*> others = all_images();
  const std::size_t share = options.gpu_bytes / (others.size() + 1);
  for (ImageLayer* layer : others) layer->set_gpu_bytes(share);  // before the new layer takes its share
  auto layer = std::make_unique<ImageLayer>(id, setup(), std::move(source), look, share);
  if (layer->gpu_bytes() > 0) return layer;
  share_gpu();
  return Error{
      fmt::format("{}: the driver has no memory for tiles; remove a layer, or give a smaller gpu_bytes", call)};
}

void Globe::Impl::forget_views_of(const ImageLayer& image) {
  const auto is_of = [&image](const LayerView* drawn) { return &drawn->layer() == &image; };
  for (GlobeView::Impl* view : views) {
    std::erase_if(view->stack, is_of);
    std::erase_if(view->planned, is_of);
  }
}

void Globe::Impl::drop_coming(LayerId id, Coming which) {
  const auto is_one = [&](const auto& layer) {
    return layer->id() == id && (which == Coming::all || layer->turn().is_ahead);
  };
  for (const auto& layer : coming) {
    if (is_one(layer)) forget_views_of(*layer);
  }
  if (std::erase_if(coming, is_one) > 0) share_gpu();
}

// A layer that is not drawn needs no tiles to be in place.
void Globe::Impl::put_in_place() {
  const auto is_due = [this](const auto& layer) {
    return !layer->turn().is_ahead && (layer->is_ready() || !image(layer->id())->is_drawn(sides()));
  };
  if (std::ranges::none_of(coming, is_due)) return;
  std::vector<std::unique_ptr<ImageLayer>> gone, lacking;
  for (auto& layer : coming) {
    if (!is_due(layer)) continue;
    const bool lacks = layer->is_void();
    const auto place = std::ranges::find(images, layer->id(), [](const auto& one) { return one->id(); });
    if (!lacks && !is_late(*layer)) {
      layer->set_look((*place)->look());
      layer->set_early((*place)->is_early());
      place->swap(layer);
      for (GlobeView::Impl* view : views) view->is_behind = true;
    }
    forget_views_of(*layer);
    (lacks ? lacking : gone).push_back(std::move(layer));
  }
  std::erase(coming, nullptr);
  for (const auto& layer : lacking) step_back(*layer);
  gone.clear();
  lacking.clear();
  share_gpu();
  restore_detail();
}

std::vector<LayerId> Globe::imagery() const {
  std::vector<LayerId> ids;
  if (!impl_->may_call("Globe::imagery")) return ids;
  for (const auto& layer : impl_->images) ids.push_back(layer->id());
  return ids;
}

Result<LayerId> Globe::add_imagery(std::shared_ptr<TileSource> source, const ImageLook& look) {
  const auto call = impl_->may_draw("Globe::add_imagery");
  if (!call) return call.error();
  const LayerId id = impl_->next_id();
  Result<std::unique_ptr<ImageLayer>> layer = impl_->make_image("Globe::add_imagery", id, std::move(source), look);
  if (!layer) return layer.error();
  impl_->images.push_back(*std::move(layer));
  impl_->restore_detail();
  return id;
}

Status Globe::set_source(LayerId imagery, std::shared_ptr<TileSource> source) {
  const auto call = impl_->may_draw("Globe::set_source");
  if (!call) return call.error();
  const ImageLayer* shown = impl_->image(imagery);
  if (shown == nullptr) return no_layer("Globe::set_source", "image layer", imagery);
  auto layer = impl_->make_image("Globe::set_source", imagery, std::move(source), shown->look());
  if (!layer) return layer.error();
  (*layer)->set_turn({.number = ++impl_->turns});
  impl_->drop_coming(imagery, Impl::Coming::all);
  impl_->coming.push_back(*std::move(layer));
  impl_->put_in_place();
  impl_->changed = true;
  return Done{};
}

bool Globe::awaits_source(LayerId imagery) const {
  if (!impl_->may_call("Globe::awaits_source")) return false;
  const ImageLayer* shown = impl_->image(imagery);
  return shown != nullptr && impl_->newest_coming(*shown) != nullptr;
}

Result<std::shared_ptr<TileSource>> Globe::source(LayerId imagery) const {
  if (Status call = impl_->may_call("Globe::source"); !call) return call.error();
  const ImageLayer* layer = impl_->image(imagery);
  if (layer == nullptr) return no_layer("Globe::source", "image layer", imagery);
  return layer->source();
}

Status Globe::set_look(LayerId imagery, const ImageLook& look) {
  if (Status call = impl_->may_call("Globe::set_look"); !call) return call;
  ImageLayer* layer = impl_->image(imagery);
  if (layer == nullptr) return no_layer("Globe::set_look", "image layer", imagery);
  if (Status good = check_look(layer->has_numbers(), look); !good) return refusal("Globe::set_look", good);
  layer->set_look(look);
  impl_->changed = true;
  return Done{};
}

Result<ImageLook> Globe::look(LayerId imagery) const {
  if (Status call = impl_->may_call("Globe::look"); !call) return call.error();
  const ImageLayer* layer = impl_->image(imagery);
  if (layer == nullptr) return no_layer("Globe::look", "image layer", imagery);
  return layer->look();
}

Status Globe::move(LayerId layer, std::size_t position) {
  const auto call = impl_->may_draw("Globe::move");
  if (!call) return call.error();
  auto& objects = impl_->objects;
  if (const auto from = std::ranges::find(objects, layer, &ObjectLayer::id); from != objects.end()) {
    move_to(objects, from, position);
    return impl_->show_layers();
  }
  auto& images = impl_->images;
  const auto from = std::ranges::find_if(images, [layer](const auto& image) { return image->id() == layer; });
  if (from == images.end()) return no_layer("Globe::move", "layer", layer);
  move_to(images, from, position);
  impl_->changed = true;
  return Done{};
}

Status Globe::remove(LayerId layer) {
  const auto call = impl_->may_draw("Globe::remove");
  if (!call) return call.error();
  if (impl_->object(layer) != nullptr) {
    std::erase_if(impl_->objects, [layer](const ObjectLayer& other) { return other.id == layer; });
    return impl_->show_layers();
  }
  ImageLayer* image = impl_->image(layer);
  if (image == nullptr) return no_layer("Globe::remove", "layer", layer);
  impl_->drop_coming(layer, Impl::Coming::all);
  impl_->forget_views_of(*image);
  impl_->following.erase(layer);
  std::erase_if(impl_->images, [image](const auto& other) { return other.get() == image; });
  impl_->share_gpu();
  impl_->restore_detail();
  return Done{};
}

Status Globe::invalidate(LayerId imagery, std::optional<TileId> tile) {
  if (Status call = impl_->may_call("Globe::invalidate"); !call) return call;
  ImageLayer* image = impl_->image(imagery);
  if (image == nullptr) return no_layer("Globe::invalidate", "image layer", imagery);
  image->invalidate(tile);
  impl_->changed = true;
  return Done{};
}

Status Globe::set_attribution(LayerId layer, std::string text) {
  if (Status call = impl_->may_call("Globe::set_attribution"); !call) return call;
  if (ObjectLayer* objects = impl_->object(layer); objects != nullptr) {
    objects->attribution = std::move(text);
    return Done{};
  }
  ImageLayer* image = impl_->image(layer);
  if (image == nullptr) return no_layer("Globe::set_attribution", "layer", layer);
  for (const auto& other : impl_->coming) {
    if (other->id() == layer) other->set_attribution(text);
  }
  image->set_attribution(std::move(text));
  return Done{};
}

Result<std::string> Globe::attribution(LayerId layer) const {
  if (Status call = impl_->may_call("Globe::attribution"); !call) return call.error();
  if (const ObjectLayer* objects = impl_->object(layer); objects != nullptr) return objects->attribution;
  if (const ImageLayer* image = impl_->image(layer); image != nullptr) return image->attribution();
  return no_layer("Globe::attribution", "layer", layer);
}

// Relief raises the vertices of patches, so all patches are discarded.
Status Globe::set_elevation(std::optional<ElevationSource> elevation) {
  const auto call = impl_->may_draw("Globe::set_elevation");
  if (!call) return call.error();
  if (!elevation && !impl_->heights) return Done{};
  if (elevation.has_value() != has_relief()) {
    impl_->renderer->set_relief(elevation.has_value());
  }
  impl_->renderer->forget_slopes();
  impl_->heights.reset();
  if (elevation) impl_->heights = std::make_unique<HeightLayer>(*elevation, impl_->options, impl_->bell);
  for (ImageLayer* layer : impl_->all_images()) layer->discard_patches();
  if (impl_->plain) impl_->plain->discard_patches();
  impl_->missing_heights.clear();
  impl_->changed = true;
  return Done{};
}

bool Globe::has_relief() const { return impl_->may_call("Globe::has_relief") && impl_->heights != nullptr; }

}  // namespace terrella
