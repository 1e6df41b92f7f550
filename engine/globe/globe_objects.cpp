#include <algorithm>

#include "globe/globe_impl.h"
#include "objects/faded_scene.h"

// The object layers of a globe.
namespace terrella {

ObjectLayer* Globe::Impl::object(LayerId id) {
  const auto found = std::ranges::find(objects, id, &ObjectLayer::id);
  return found == objects.end() ? nullptr : &*found;
}

std::vector<LayerId> Globe::objects() const {
  std::vector<LayerId> ids;
  if (!impl_->may_call("Globe::objects")) return ids;
  for (const ObjectLayer& layer : impl_->objects) ids.push_back(layer.id);
  return ids;
}

Result<LayerId> Globe::add_objects(ObjectScene objects, bool shown) {
  const auto call = impl_->may_draw("Globe::add_objects");
  if (!call) return call.error();
  const LayerId id = impl_->next_id();
  impl_->objects.push_back({id, std::move(objects), shown});
  if (Status made = impl_->upload_objects(); !made) {
    impl_->objects.pop_back();
    return made.error();
  }
  return id;
}

Status Globe::set_objects(LayerId layer, ObjectScene objects) {
  const auto call = impl_->may_draw("Globe::set_objects");
  if (!call) return call.error();
  ObjectLayer* changed = impl_->object(layer);
  if (changed == nullptr) return no_layer("Globe::set_objects", "object layer", layer);
  const bool was_drawn = changed->is_drawn();
  changed->scene = std::move(objects);
  changed->line_length.reset();
  changed->cut.reset();
  changed->faded.reset();
  return was_drawn || changed->is_drawn() ? impl_->upload_objects() : Status(Done{});
}

Status Globe::show_objects(LayerId layer, bool shown) {
  const auto call = impl_->may_draw("Globe::show_objects");
  if (!call) return call.error();
  ObjectLayer* changed = impl_->object(layer);
  if (changed == nullptr) return no_layer("Globe::show_objects", "object layer", layer);
  if (std::exchange(changed->shown, shown) == shown) return Done{};
  return impl_->upload_objects();
}

Status Globe::fade_objects(LayerId layer, double opacity) {
  const auto call = impl_->may_draw("Globe::fade_objects");
  if (!call) return call.error();
  ObjectLayer* changed = impl_->object(layer);
  if (changed == nullptr) return no_layer("Globe::fade_objects", "object layer", layer);
  if (Status good = check_opacity("Globe::fade_objects", opacity); !good) return good;
  if (std::exchange(changed->opacity, opacity) == opacity) return Done{};
  changed->faded.reset();
  return impl_->upload_objects();
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
Status Globe::Impl::upload_objects() {
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

}  // namespace terrella
