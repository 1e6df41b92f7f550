#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/range_check.h"
#include "globe/globe_impl.h"
#include "globe/object_checks.h"
#include "globe/object_ranges.h"

// The object layers of a globe.
namespace terrella {
namespace {

/// Removes the edits with a value out of range. Returns the first error.
template <class Edit>
Status take_faulty(std::vector<Edit>& edits) {
  Status first = Done{};
  std::erase_if(edits, [&first](const Edit& edit) {
    const Status good = check_values(edit);
    if (first && !good) first = good;
    return !good;
  });
  return first;
}

/// Part of GlobeOptions::gpu_bytes that pictures of the ground may take.
constexpr std::size_t kGroundShare = 4;

Status check_opacity(double opacity) { return RangeCheck().in("the opacity", opacity, 0.0, 1.0).result(); }

Status report(const std::vector<ObjectId>& ids, std::string_view lack, std::string_view cure) {
  if (ids.empty()) return Done{};
  const std::string more = ids.size() == 1 ? "" : fmt::format(" and {} other ids", ids.size() - 1);
  return Error{fmt::format("Globe::edit_objects: {} {}{}; {}. The other edits are made", lack,
                           static_cast<std::uint64_t>(ids.front()), more, cure)};
}

Status report(const UnknownObjects& unknown) {
  if (Status good = report(unknown.ids, "the layer has no object", "add them first"); !good) return good;
  if (Status good = report(unknown.without_line, "only a feature with one line grows, and such is not", "add one line");
      !good) {
    return good;
  }
  return report(unknown.without_shape, "only a feature with one line or one area gets another shape, and such is not",
                "add one, and give a line one way");
}

}  // namespace

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
  if (Status good = check_objects(objects); !good) return refusal("Globe::add_objects", good);
  const LayerId id = impl_->next_id();
  ObjectLayer& layer = impl_->objects.emplace_back(id, shown, impl_->bell);
  impl_->objects_cut += layer.set(std::move(objects), impl_->options.body.ellipsoid, impl_->shared_relief());
  if (Status made = impl_->show_layers(); !made) {
    impl_->objects.pop_back();
    static_cast<void>(impl_->show_layers());
    return made.error();
  }
  return id;
}

Status Globe::set_objects(LayerId layer, ObjectScene objects) {
  const auto call = impl_->may_draw("Globe::set_objects");
  if (!call) return call.error();
  ObjectLayer* changed = impl_->object(layer);
  if (changed == nullptr) return no_layer("Globe::set_objects", "object layer", layer);
  if (Status good = check_objects(objects); !good) return refusal("Globe::set_objects", good);
  impl_->objects_cut += changed->set(std::move(objects), impl_->options.body.ellipsoid, impl_->shared_relief());
  return impl_->show_layers();
}

// The frame uploads what the edits change. So most edits need no OpenGL; a layer that begins to be drawn does.
Status Globe::edit_objects(LayerId layer, ObjectEdits edits) {
  if (Status call = impl_->may_call("Globe::edit_objects"); !call) return call;
  ObjectLayer* changed = impl_->object(layer);
  if (changed == nullptr) return no_layer("Globe::edit_objects", "object layer", layer);
  if (Status good = check_objects(edits.add, changed->newest(), edits.remove); !good) {
    return Error{refusal("Globe::edit_objects", good).message + ". No edit is made"};
  }
  const Status values = RangeCheck()
                            .part("moves", take_faulty(edits.moves))
                            .part("growths", take_faulty(edits.growths))
                            .part("shapes", take_faulty(edits.shapes))
                            .part("changes", take_faulty(edits.changes))
                            .result();
  UnknownObjects unknown;
  const bool was_drawn = changed->is_drawn();
  impl_->objects_cut += changed->edit(std::move(edits), unknown);
  impl_->changed = true;
  if (changed->is_drawn() != was_drawn) {
    const auto call = impl_->may_draw("Globe::edit_objects");
    if (!call) return call.error();
    if (Status shown = impl_->show_layers(); !shown) return shown;
  }
  if (!values) return Error{refusal("Globe::edit_objects", values).message + ". The other edits are made"};
  return report(unknown);
}

Status Globe::show_objects(LayerId layer, bool shown) {
  const auto call = impl_->may_draw("Globe::show_objects");
  if (!call) return call.error();
  ObjectLayer* changed = impl_->object(layer);
  if (changed == nullptr) return no_layer("Globe::show_objects", "object layer", layer);
  if (std::exchange(changed->shown, shown) == shown) return Done{};
  return impl_->show_layers();
}

Status Globe::fade_objects(LayerId layer, double opacity) {
  const auto call = impl_->may_draw("Globe::fade_objects");
  if (!call) return call.error();
  ObjectLayer* changed = impl_->object(layer);
  if (changed == nullptr) return no_layer("Globe::fade_objects", "object layer", layer);
  if (Status good = check_opacity(opacity); !good) return refusal("Globe::fade_objects", good);
  if (changed->opacity() == opacity) return Done{};
  changed->set_opacity(opacity);
  return impl_->show_layers();
}

std::vector<MissingFill> Globe::missing_fills(LayerId layer) const {
  if (!impl_->may_call("Globe::missing_fills")) return {};
  const ObjectLayer* objects = impl_->object(layer);
  return objects == nullptr ? std::vector<MissingFill>() : objects->newest()->missing_fills();
}

Status Globe::Impl::show_layers() {
  changed = true;
  std::vector<DrawnLayer> layers;
  for (ObjectLayer& layer : objects) {
    static_cast<void>(layer.take_replaced());
    if (layer.is_drawn()) layers.push_back(layer.drawn());
  }
  return renderer->set_objects(std::move(layers));
}

// A program that cannot be made is reported by the frame.
void Globe::Impl::take_cuts() {
  bool replaced = false;
  for (ObjectLayer& layer : objects) {
    const std::size_t taken = layer.take_cuts() + layer.follow(options.body.ellipsoid, shared_relief());
    objects_cut += taken;
    changed = changed || taken > 0;
    replaced = layer.take_replaced() || replaced;
  }
  if (replaced) static_cast<void>(show_layers());
  follow_ground();
}

std::size_t Globe::Impl::ground_bytes() const { return options.gpu_bytes / kGroundShare; }

void Globe::Impl::follow_ground() {
  std::vector<DrawnLayer> layers;
  for (ObjectLayer& layer : objects) {
    if (layer.is_drawn()) layers.push_back(layer.drawn());
  }
  const bool any =
      std::ranges::any_of(layers, [](const DrawnLayer& layer) { return !layer.objects->batches().ground.empty(); });
  if (!ground_pictures && any) {
    ground_pictures = std::make_unique<GroundPictures>(ground_bytes(), bell);
  }
  if (ground_pictures && ground_pictures->follow(layers)) changed = true;
}

}  // namespace terrella
