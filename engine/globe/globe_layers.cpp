#include <fmt/format.h>

#include <algorithm>

#include "globe/globe_impl.h"

// The image layers and the heights of a globe, and the state that all layers share.
namespace terrella {
namespace {

Status check_grid(const TileGrid& grid) {
  const auto wrong = [](std::string what) {
    return Error{"Globe::add_imagery: the description of the source's grid is wrong: " + what};
  };
  if (!(grid.root_span_deg > 0.0 && grid.root_span_deg <= 1e4)) {
    return wrong(fmt::format("tiles of level 0 that span {}°", grid.root_span_deg));
  }
  if (grid.tile_px < 16 || grid.tile_px > 4096) return wrong(fmt::format("tiles of {} pixels", grid.tile_px));
  if (grid.min_level < 0 || grid.max_level < grid.min_level || grid.max_level > kMaxTileLevel) {
    return wrong(fmt::format("levels from {} to {}", grid.min_level, grid.max_level));
  }
  return Done{};
}

/// A layer of numbers needs a stretch and a colour map, a layer of pictures has none.
Status check_numbers(const std::string& call, bool has_numbers, const ImageLook& look) {
  if (has_numbers && !look.numbers) {
    return Error{call + ": the tiles are numbers; give their stretch and colour map (ImageLook::numbers)"};
  }
  if (!has_numbers && look.numbers) {
    return Error{call + ": the tiles are pictures, which have no stretch; leave ImageLook::numbers empty"};
  }
  if (!look.numbers) return Done{};
  const Status good = check_look(*look.numbers);
  return good ? good : Error{call + ": " + good.error().message};
}

}  // namespace

Error no_layer(const char* call, const char* kind, LayerId id) {
  return Error{fmt::format("{}: the globe has no {} {} (removed before, or another globe's)", call, kind,
                           static_cast<std::uint64_t>(id))};
}

Status check_opacity(const char* call, double opacity) {
  if (opacity >= 0.0 && opacity <= 1.0) return Done{};
  return Error{fmt::format("{}: an opacity of {}; give one from 0 to 1", call, opacity)};
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
  if (!source) return Error{"Globe::add_imagery: there is no source; open one first (open_tile_set())"};
  if (Status good = check_grid(source->info().grid); !good) return good.error();
  if (Status good = check_opacity("Globe::add_imagery", look.opacity); !good) return good.error();
  const bool has_numbers = source->info().numbers.has_value();
  if (Status good = check_numbers("Globe::add_imagery", has_numbers, look); !good) return good.error();
  auto& images = impl_->images;
  const LayerId id = impl_->next_id();
  const std::size_t share = impl_->options.gpu_bytes / (images.size() + 1);
  for (const auto& layer : images) layer->set_gpu_bytes(share);  // before the new layer takes its share
  images.push_back(std::make_unique<ImageLayer>(id, impl_->setup(), std::move(source), look, share));
  impl_->restore_detail();
  return id;
}

Status Globe::set_look(LayerId imagery, const ImageLook& look) {
  if (Status call = impl_->may_call("Globe::set_look"); !call) return call;
  ImageLayer* layer = impl_->image(imagery);
  if (layer == nullptr) return no_layer("Globe::set_look", "image layer", imagery);
  if (Status good = check_opacity("Globe::set_look", look.opacity); !good) return good;
  if (Status good = check_numbers("Globe::set_look", layer->has_numbers(), look); !good) return good;
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

bool Globe::has_relief() const { return impl_->heights != nullptr; }

}  // namespace terrella
