#include <algorithm>
#include <utility>

#include "objects/ground/on_ground.h"
#include "objects/layer_objects.h"

// The objects of a layer that stand on the ground or lie on it.
namespace terrella {

void LayerObjects::put_on_ground(KeptOnGround& kept, GroundObject object) {
  if (kept.place == GroundBatch::kNone) {
    if (object.shape) kept.place = batches_.ground.add(std::move(object));
  } else if (object.shape) {
    batches_.ground.change(kept.place, std::move(object));
  } else {
    batches_.ground.change(std::exchange(kept.place, GroundBatch::kNone), {});
    kept.shape.reset();
  }
}

// A line that is cut anew mostly has as many vertices as before.
void LayerObjects::put(SlotBatch<LineVertex>& lines, Slot& slot, std::size_t bucket,
                       std::span<const LineVertex> vertices) {
  if (slot.count > 0 && slot.count == vertices.size()) {
    std::ranges::copy(vertices, lines.change(slot).begin());
    return;
  }
  lines.drop(slot);
  slot = lines.add(bucket, vertices);
}

glm::dvec3 LayerObjects::place_of(const Geodetic& place, HeightMode mode) const {
  return ellipsoid_.to_ecef(over_ground(place, mode, ground_)).xyz_m;
}

HeightMode LayerObjects::mode_of(PartRef part) const {
  switch (part.kind) {
    case ObjectKind::point:
      return points_[part.index].object.heights;
    case ObjectKind::line:
      return lines_[part.index].object->heights;
    case ObjectKind::polygon:
      return areas_[part.index].object->heights;
    case ObjectKind::mesh:
      return meshes_[part.index].object.heights;
    case ObjectKind::label:
      break;
  }
  return labels_[part.index].object.heights;
}

bool LayerObjects::depends_on_ground(PartRef part) const {
  if (part.kind == ObjectKind::line && is_draped(*lines_[part.index].object)) return false;
  if (part.kind == ObjectKind::polygon && is_draped(*areas_[part.index].object)) return false;
  return mode_of(part) != HeightMode::absolute;
}

void LayerObjects::follow(PartRef part, const std::function<bool(const Geodetic&)>& has_changed) {
  const Kept& object = kept(part);
  if (object.removed || !depends_on_ground(part)) return;
  const auto stand = [&](auto& one) {
    if (!has_changed(one.object.place)) return false;
    one.place_m = place_of(one.object.place, one.object.heights);
    return true;
  };
  bool moved = false;
  if (part.kind == ObjectKind::point) {
    moved = stand(points_[part.index]);
  } else if (part.kind == ObjectKind::mesh) {
    moved = stand(meshes_[part.index]);
  } else if (part.kind == ObjectKind::label) {
    stand(labels_[part.index]);
  } else if (part.kind == ObjectKind::line) {
    KeptLine& line = lines_[part.index];
    if (std::ranges::none_of(line.object->places, has_changed)) return;
    line.picked.reset();
    if (std::exchange(line.asked, false)) ask_for(part.index, line);
  } else {
    KeptArea& area = areas_[part.index];
    if (std::ranges::none_of(area.object->rings,
                             [&](const auto& ring) { return std::ranges::any_of(ring, has_changed); })) {
      return;
    }
    area.picked.reset();
    area.asked_fill = area.asked_outline = false;
    ask_for(part.index, area);
  }
  if (!moved) return;
  draw_again(part);
  if (index_) index_part(part);
}

// Lines and areas at height 0 lie on ground without heights, and stay where they are when heights raise it.
void LayerObjects::cut_again_on_other_ground() {
  for (std::uint32_t k = 0; k < lines_.size(); ++k) {
    KeptLine& line = lines_[k];
    if (line.removed || !line.asked || lies_on_ground(*line.object, ground_) == line.ground.lies) continue;
    line.asked = false;
    ask_for(k, line);
  }
  for (std::uint32_t k = 0; k < areas_.size(); ++k) {
    KeptArea& area = areas_[k];
    if (area.removed || lies_on_ground(*area.object, ground_) == area.ground.lies) continue;
    area.asked_fill = area.asked_outline = false;
    ask_for(k, area);
  }
}

void LayerObjects::follow(const Ground& ground, const std::function<bool(const Geodetic&)>& has_changed) {
  const bool other = ground.has_relief() != ground_.has_relief();
  ground_ = ground;
  if (other) cut_again_on_other_ground();
  if (!stands_on_ground()) return;
  const auto each = [&](ObjectKind kind, std::size_t count) {
    for (std::uint32_t k = 0; k < count; ++k) follow({kind, k}, has_changed);
  };
  each(ObjectKind::point, points_.size());
  each(ObjectKind::line, lines_.size());
  each(ObjectKind::polygon, areas_.size());
  each(ObjectKind::mesh, meshes_.size());
  each(ObjectKind::label, labels_.size());
}

}  // namespace terrella
