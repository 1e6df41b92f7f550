#include "objects/layer_objects.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <utility>

#include "objects/label_layout.h"

namespace terrella {
namespace {

/// Removed objects are forgotten once they are this many, and more than the others.
constexpr std::size_t kFewRemoved = 1000;

std::uint64_t next_serial() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

LayerObjects::LayerObjects(ObjectScene scene, const Ground& ground, double opacity, ObjectColor selected_color)
    : serial_(next_serial()),
      ellipsoid_(ground.ellipsoid()),
      opacity_(opacity),
      selected_color_(selected_color),
      job_{.ellipsoid = ground.ellipsoid()},
      ground_(ground) {
  add(std::move(scene));
}

const Kept& LayerObjects::kept(PartRef part) const {
  switch (part.kind) {
    case ObjectKind::point:
      return points_[part.index];
    case ObjectKind::line:
      return lines_[part.index];
    case ObjectKind::polygon:
      return areas_[part.index];
    case ObjectKind::mesh:
      return meshes_[part.index];
    case ObjectKind::label:
      break;
  }
  return labels_[part.index];
}

void LayerObjects::link(PartRef part, ObjectId id) {
  ++live_;
  Kept& object = kept(part);
  on_ground_ += depends_on_ground(part) ? 1U : 0U;
  if (id != ObjectId::none) object.next = std::exchange(parts_[static_cast<std::uint64_t>(id)], part);
  if (index_) index_part(part);
}

template <class Object, class List>
std::uint32_t LayerObjects::keep(ObjectKind kind, Object object, List& list) {
  list.emplace_back();
  list.back().number = numbers_[static_cast<std::size_t>(kind)]++;
  list.back().object = std::move(object);
  return static_cast<std::uint32_t>(list.size() - 1);
}

void LayerObjects::add(ObjectScene scene) {
  length_ = length_ + line_length(scene);
  for (PointObject& point : scene.points) add(std::move(point));
  for (LineObject& line : scene.lines) {
    const std::uint32_t index = keep(ObjectKind::line, std::make_shared<LineObject>(std::move(line)), lines_);
    const LineObject& object = *lines_[index].object;
    most_reach_px_ = std::max(most_reach_px_, 0.5 * double(object.width_px));
    ask_for(index, lines_[index]);
    link({ObjectKind::line, index}, object.of.id);
    add_arrows(index);
  }
  for (PolygonObject& polygon : scene.polygons) {
    const std::uint32_t index = keep(ObjectKind::polygon, std::make_shared<PolygonObject>(std::move(polygon)), areas_);
    const PolygonObject& object = *areas_[index].object;
    most_reach_px_ = std::max(most_reach_px_, 0.5 * double(object.stroke_width_px));
    ask_for(index, areas_[index]);
    link({ObjectKind::polygon, index}, object.of.id);
  }
  for (MeshObject& mesh : scene.meshes) add(std::move(mesh));
  const std::size_t first_label = labels_.size();
  for (LabelObject& label : scene.labels) add(std::move(label));
  if (first_label < labels_.size()) order_labels(first_label);
}

void LayerObjects::add(PointObject point) {
  const std::uint32_t index = keep(ObjectKind::point, std::move(point), points_);
  KeptPoint& kept = points_[index];
  kept.place_m = place_of(kept.object.place, kept.object.heights);
  most_reach_px_ = std::max(most_reach_px_, reach_px(kept.object));
  draw(kept);
  link({ObjectKind::point, index}, kept.object.of.id);
}

void LayerObjects::add(MeshObject mesh) {
  const std::uint32_t index = keep(ObjectKind::mesh, std::move(mesh), meshes_);
  KeptMesh& kept = meshes_[index];
  kept.place_m = place_of(kept.object.place, kept.object.heights);
  draw(kept);
  link({ObjectKind::mesh, index}, kept.object.of.id);
}

void LayerObjects::add(LabelObject label) {
  const std::uint32_t index = keep(ObjectKind::label, std::move(label), labels_);
  KeptLabel& kept = labels_[index];
  kept.place_m = place_of(kept.object.place, kept.object.heights);
  kept.text = label_text(kept.object.text);
  ++label_counts_[is_underground(kept.object) ? 1 : 0];
  link({ObjectKind::label, index}, kept.object.of.id);
}

/// Sorts the labels from `first` on into the order.
void LayerObjects::order_labels(std::size_t first) {
  ++label_version_;
  const auto before = [this](std::uint32_t a, std::uint32_t b) {
    return labels_[a].object.priority > labels_[b].object.priority;
  };
  const auto old = std::ssize(label_order_);
  for (std::size_t k = first; k < labels_.size(); ++k) label_order_.push_back(static_cast<std::uint32_t>(k));
  std::stable_sort(label_order_.begin() + old, label_order_.end(), before);
  std::inplace_merge(label_order_.begin(), label_order_.begin() + old, label_order_.end(), before);
}

bool LayerObjects::remove(ObjectId id) {
  if (!each_part(id, [this](PartRef part) { take_away(part); })) return false;
  parts_.erase(static_cast<std::uint64_t>(id));
  tracks_.erase(static_cast<std::uint64_t>(id));
  return true;
}

void LayerObjects::take_away(PartRef part) {
  Kept& object = kept(part);
  object.removed = true;
  object.visible = false;
  --live_;
  ++removed_;
  on_ground_ -= depends_on_ground(part) ? 1U : 0U;
  if (index_) index_part(part);
  drop(part);
}

bool LayerObjects::has(ObjectPart part) const {
  if (label_counts_[part == ObjectPart::underground ? 1 : 0] > 0) return true;
  for (const bool opaque : {true, false}) {
    if (batches_.spheres.ranges.range(part, opaque, ObjectChoice::all).count > 0) return true;
  }
  if (batches_.markers.has(part) || batches_.icons.has(part)) return true;
  if (batches_.lines.has(part) || batches_.casings.has(part) || batches_.fill_vertices.has(part)) return true;
  if (batches_.solids.has(part)) return true;
  return std::ranges::any_of(batches_.models, [part](const ModelStands& model) { return model.stands.has(part); });
}

ObjectColor LayerObjects::drawn(ObjectColor color, const Kept& kept) const {
  if (kept.selected) color = {selected_color_.red, selected_color_.green, selected_color_.blue, color.alpha};
  color.alpha = kept.is_shown() ? static_cast<std::uint8_t>(std::lround(opacity_ * color.alpha)) : std::uint8_t{0};
  return color;
}

void LayerObjects::set_opacity(double opacity) {
  if (std::exchange(opacity_, opacity) != opacity) place_all_again();
}

void LayerObjects::set_selected_color(ObjectColor color) {
  if (std::exchange(selected_color_, color) == color) return;
  for (const auto& [id, first] : parts_) {
    for (PartRef part = first; part; part = kept(part).next) {
      if (kept(part).selected && !kept(part).removed) draw_again(part);
    }
  }
}

void LayerObjects::tidy() {
  if (removed_ > kFewRemoved && removed_ > live_ && jobs_out_ == 0 && job_.empty() && grown_.empty()) {
    forget_removed();
    place_all_again();
  }
  if (replaced_ > kFewRemoved / 10 && replaced_ > areas_.size()) place_all_again();
  if (batches_.spheres.stale) sort_spheres();
}

// The indices of the objects change, and with them everything that names them. A cut that is still being made names
// objects by their index, so nothing is forgotten while a worker has a job.
void LayerObjects::forget_removed() {
  forget_removed_lines();
  const auto forget = [](auto& objects) { std::erase_if(objects, [](const Kept& one) { return one.removed; }); };
  forget(points_);
  forget(areas_);
  forget(meshes_);
  forget(labels_);
  serial_ = next_serial();
  index_.reset();
  parts_.clear();
  live_ = removed_ = on_ground_ = 0;
  const auto link_all = [this](ObjectKind kind, auto& objects, const auto& id) {
    for (std::uint32_t k = 0; k < objects.size(); ++k) {
      objects[k].next = {};
      link({kind, k}, id(objects[k]));
    }
  };
  const auto own = [](const auto& one) { return one.object.of.id; };
  const auto shared = [](const auto& one) { return one.object->of.id; };
  link_all(ObjectKind::point, points_, own);
  link_all(ObjectKind::line, lines_, shared);
  link_all(ObjectKind::polygon, areas_, shared);
  link_all(ObjectKind::mesh, meshes_, own);
  link_all(ObjectKind::label, labels_, own);
  for (auto& [id, track] : tracks_) find_arrows(ObjectId{id}, track);
  label_order_.clear();
  order_labels(0);
}

}  // namespace terrella
