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

void Globe::Impl::share_gpu() {
  for (const auto& layer : images) layer->set_gpu_bytes(options.gpu_bytes / images.size());
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
  if (!source) {
    return Error{
        "Globe::add_imagery: there is no source; open one first (open_tile_set()), or give painted_tiles() a function"};
  }
  if (Status good = check_source(source->info()); !good) return refusal("Globe::add_imagery: the source", good);
  const bool has_numbers = source->info().numbers.has_value();
  if (Status good = check_look(has_numbers, look); !good) return refusal("Globe::add_imagery", good);
  auto& images = impl_->images;
  const LayerId id = impl_->next_id();
  const std::size_t share = impl_->options.gpu_bytes / (images.size() + 1);
  for (const auto& layer : images) layer->set_gpu_bytes(share);  // before the new layer takes its share
  auto layer = std::make_unique<ImageLayer>(id, impl_->setup(), std::move(source), look, share);
  if (layer->gpu_bytes() == 0) {
    impl_->share_gpu();
    return Error{"Globe::add_imagery: the driver has no memory for tiles; remove a layer, or give a smaller gpu_bytes"};
  }
  images.push_back(std::move(layer));
  impl_->restore_detail();
  return id;
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
  for (GlobeView::Impl* view : impl_->views) {
    std::erase_if(view->stack, [image](const LayerView* drawn) { return &drawn->layer() == image; });
  }
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
  for (const auto& layer : impl_->images) layer->discard_patches();
  if (impl_->plain) impl_->plain->discard_patches();
  impl_->missing_heights.clear();
  impl_->changed = true;
  return Done{};
}

bool Globe::has_relief() const { return impl_->may_call("Globe::has_relief") && impl_->heights != nullptr; }

}  // namespace terrella
