#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "globe/globe_impl.h"
#include "objects/faded_scene.h"

// The layers of a globe at run time: imagery, objects, heights.
namespace terrella {
namespace {

Error no_layer(const char* call, const char* kind, LayerId id) {
  return Error{fmt::format("{}: the globe has no {} {} (removed before, or another globe's)", call, kind,
                           static_cast<std::uint64_t>(id))};
}

Status check_grid(const TileGrid& grid) {
  const auto wrong = [](std::string what) {
    return Error{"Globe::add_imagery: the source says of its grid what cannot be: " + what};
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

Status check_opacity(const char* call, double opacity) {
  if (opacity >= 0.0 && opacity <= 1.0) return Done{};
  return Error{fmt::format("{}: an opacity of {}; give one from 0 to 1", call, opacity)};
}

/// Moves the element at `from` so that `position` others are before it, or to the end.
template <class T>
void move_to(std::vector<T>& all, typename std::vector<T>::iterator from, std::size_t position) {
  const auto to = all.begin() + static_cast<std::ptrdiff_t>(std::min(position, all.size() - 1));
  from < to ? std::rotate(from, from + 1, to + 1) : std::rotate(to, from, from + 1);
}

}  // namespace

Result<LayerId> Globe::Impl::add_imagery(std::shared_ptr<TileSource> source, const ImageLook& look) {
  if (!source) return Error{"Globe::add_imagery: there is no source; open one first (open_tile_set())"};
  if (Status good = check_grid(source->info().grid); !good) return good.error();
  if (Status good = check_opacity("Globe::add_imagery", look.opacity); !good) return good.error();
  const LayerId id = next_id();
  const std::size_t share = options.gpu_bytes / (images.size() + 1);
  for (const auto& layer : images) layer->set_gpu_bytes(share);  // before the new layer takes its share
  images.push_back(std::make_unique<ImageLayer>(id, options, std::move(source), look, share, bell));
  restore_detail();
  return id;
}

ImageLayer* Globe::Impl::image(LayerId id) const {
  const auto found = std::ranges::find_if(images, [id](const auto& layer) { return layer->id() == id; });
  return found == images.end() ? nullptr : found->get();
}

ObjectLayer* Globe::Impl::object(LayerId id) {
  const auto found = std::ranges::find(objects, id, &ObjectLayer::id);
  return found == objects.end() ? nullptr : &*found;
}

Status Globe::Impl::set_look(LayerId id, const ImageLook& look) {
  ImageLayer* layer = image(id);
  if (layer == nullptr) return no_layer("Globe::set_look", "image layer", id);
  if (Status good = check_opacity("Globe::set_look", look.opacity); !good) return good;
  layer->set_look(look);
  changed = true;
  return Done{};
}

Result<ImageLook> Globe::Impl::look(LayerId id) const {
  const ImageLayer* layer = image(id);
  if (layer == nullptr) return no_layer("Globe::look", "image layer", id);
  return layer->look();
}

Status Globe::Impl::move(LayerId id, std::size_t position) {
  if (const auto from = std::ranges::find(objects, id, &ObjectLayer::id); from != objects.end()) {
    move_to(objects, from, position);
    return show_objects();
  }
  const auto from = std::ranges::find_if(images, [id](const auto& layer) { return layer->id() == id; });
  if (from == images.end()) return no_layer("Globe::move", "layer", id);
  move_to(images, from, position);
  changed = true;
  return Done{};
}

Status Globe::Impl::remove(LayerId id) {
  if (object(id) != nullptr) {
    std::erase_if(objects, [id](const ObjectLayer& layer) { return layer.id == id; });
    return show_objects();
  }
  ImageLayer* layer = image(id);
  if (layer == nullptr) return no_layer("Globe::remove", "layer", id);
  std::erase(stack, layer);
  std::erase_if(images, [id](const auto& other) { return other->id() == id; });
  share_gpu();
  restore_detail();
  return Done{};
}

void Globe::Impl::share_gpu() {
  for (const auto& layer : images) layer->set_gpu_bytes(options.gpu_bytes / images.size());
}

Result<LayerId> Globe::Impl::add_objects(ObjectScene scene, bool shown) {
  const LayerId id = next_id();
  objects.push_back({id, std::move(scene), shown});
  if (Status made = show_objects(); !made) {
    objects.pop_back();
    return made.error();
  }
  return id;
}

Status Globe::Impl::set_objects(LayerId id, ObjectScene scene) {
  ObjectLayer* layer = object(id);
  if (layer == nullptr) return no_layer("Globe::set_objects", "object layer", id);
  const bool was_drawn = layer->is_drawn();
  layer->scene = std::move(scene);
  layer->line_length.reset();
  layer->cut.reset();
  layer->faded.reset();
  return was_drawn || layer->is_drawn() ? show_objects() : Status(Done{});
}

Status Globe::Impl::show_objects(LayerId id, bool shown) {
  ObjectLayer* layer = object(id);
  if (layer == nullptr) return no_layer("Globe::show_objects", "object layer", id);
  if (std::exchange(layer->shown, shown) == shown) return Done{};
  return show_objects();
}

Status Globe::Impl::fade_objects(LayerId id, double opacity) {
  ObjectLayer* layer = object(id);
  if (layer == nullptr) return no_layer("Globe::fade_objects", "object layer", id);
  if (Status good = check_opacity("Globe::fade_objects", opacity); !good) return good;
  if (std::exchange(layer->opacity, opacity) == opacity) return Done{};
  layer->faded.reset();
  return show_objects();
}

// Cuts a scene once. Fading the scene changes only its colours.
CutScene Globe::Impl::cut_scene(ObjectLayer& layer, Angle step) {
  if (!layer.cut || layer.cut->step != step) {
    layer.cut = cut_objects(layer.scene, options.body.ellipsoid, step);
    objects_cut += layer.scene.lines.size() + layer.scene.polygons.size();
  }
  if (layer.opacity == 1.0) return {layer.scene, *layer.cut};
  if (!layer.faded) layer.faded = faded(layer.scene, layer.opacity);
  return {*layer.faded, *layer.cut};
}

// Objects that one draw takes must be contiguous, across layers.
Status Globe::Impl::show_objects() {
  changed = true;
  std::vector<ObjectLayer*> seen;
  for (ObjectLayer& layer : objects) {
    if (layer.is_drawn()) seen.push_back(&layer);
  }
  Angle length{};
  for (ObjectLayer* layer : seen) {
    if (!layer->line_length) layer->line_length = line_length(layer->scene);
    length = length + *layer->line_length;
  }
  std::vector<CutScene> scenes;
  for (ObjectLayer* layer : seen) scenes.push_back(cut_scene(*layer, line_step(length)));
  return renderer->set_objects(scenes);
}

Status Globe::Impl::set_attribution(LayerId id, std::string text) {
  if (ObjectLayer* layer = object(id); layer != nullptr) {
    layer->attribution = std::move(text);
    return Done{};
  }
  ImageLayer* layer = image(id);
  if (layer == nullptr) return no_layer("Globe::set_attribution", "layer", id);
  layer->set_attribution(std::move(text));
  return Done{};
}

std::vector<std::string> Globe::Impl::attributions() const {
  std::vector<std::string> texts;
  const auto add = [&texts](const std::string& text) {
    if (!text.empty() && std::ranges::find(texts, text) == texts.end()) texts.push_back(text);
  };
  for (const ImageLayer* layer : stack) {
    if (layer->is_on_screen()) add(layer->attribution());
  }
  if (stack.empty() || stack.front()->patches().empty()) return texts;
  if (relief && relief->field().size() > 0) add(heights_attribution);
  for (const ObjectLayer& layer : objects) {
    if (layer.is_drawn()) add(layer.attribution);
  }
  return texts;
}

void Globe::Impl::make_relief(const ElevationSource& elevation) {
  relief =
      std::make_shared<Relief>(options.body.ellipsoid, elevation.grid(), options.exaggeration, options.height_bytes);
  heights.emplace(HeightLoader(elevation, {.bell = bell}), relief->tiles(), LayerId::none, options.retry_after);
  heights_attribution = elevation.tiles()->info().attribution;
}

// Relief raises the vertices of patches and adds slopes, so all patches are discarded.
Status Globe::Impl::set_elevation(const std::optional<ElevationSource>& elevation) {
  if (!elevation && !relief) return Done{};
  if (elevation.has_value() != (relief != nullptr)) {
    if (Status made = renderer->set_relief(elevation.has_value()); !made) return made;
  }
  relief.reset();
  heights.reset();
  if (elevation) make_relief(*elevation);
  for (const auto& layer : images) layer->discard_patches();
  if (plain) plain->discard_patches();
  lacking_heights.clear();
  changed = true;
  return Done{};
}

}  // namespace terrella
