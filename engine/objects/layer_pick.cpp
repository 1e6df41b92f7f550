#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "objects/layer_objects.h"
#include "objects/object_shapes.h"

// Picks of a layer by its spatial index.
namespace terrella {
namespace {

// An item of the index is a kind and an index in the layer's list of that kind.
constexpr unsigned kKinds = 4;
std::uint32_t item_of(PartRef part) { return part.index * kKinds + static_cast<std::uint32_t>(part.kind); }
PartRef part_of(std::uint32_t item) { return {static_cast<ObjectKind>(item % kKinds), item / kKinds}; }

/// A ball around places and all that is drawn between them, and within them if they are a ring. `between` is the
/// longest way between neighbours. The interior of a ring lies over the plane of the ring by less than the ring's
/// radius, unless the ring goes about half round the planet.
Ball ball_of(const std::vector<std::vector<Geodetic>>& lists, const Ellipsoid& ellipsoid, bool closed) {
  glm::dvec3 low_m(HUGE_VAL), high_m(-HUGE_VAL);
  double lowest_m = 0.0, highest_m = 0.0;
  Angle between{};
  for (const auto& places : lists) {
    for (std::size_t k = 0; k < places.size(); ++k) {
      const glm::dvec3 at_m = ellipsoid.to_ecef(places[k]).xyz_m;
      low_m = glm::min(low_m, at_m);
      high_m = glm::max(high_m, at_m);
      lowest_m = std::min(lowest_m, places[k].height_m);
      highest_m = std::max(highest_m, places[k].height_m);
      if (k > 0 || closed)
        between = std::max(between, length_of({places[(k == 0 ? places.size() : k) - 1], places[k]}));
    }
  }
  Ball ball{0.5 * (low_m + high_m), 0.5 * glm::length(high_m - low_m)};
  const double a_m = ellipsoid.a_m();
  constexpr double kShare = 1.02, kNear_m = 100.0;
  ball.radius_m = kShare * (ball.radius_m + (highest_m - lowest_m) + 2.0 * sag_m(ellipsoid, between)) + kNear_m;
  if (!(ball.radius_m < 0.3 * a_m)) return {glm::dvec3(0.0), HUGE_VAL};
  return ball;
}

}  // namespace

void LayerObjects::index_all() {
  index_ = std::make_unique<ObjectIndex>();
  const auto each = [this](ObjectKind kind, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) index_part({kind, static_cast<std::uint32_t>(k)});
  };
  each(ObjectKind::point, points_.size());
  each(ObjectKind::line, lines_.size());
  each(ObjectKind::polygon, areas_.size());
  each(ObjectKind::mesh, meshes_.size());
}

void LayerObjects::index_part(PartRef part) {
  if (part.kind == ObjectKind::label) return;
  if (kept(part).removed) return index_->remove(item_of(part));
  if (part.kind == ObjectKind::point) {
    const KeptPoint& point = points_[part.index];
    index_->put(item_of(part), {point.place_m, std::max(0.0, point.object.radius_m)});
  } else if (part.kind == ObjectKind::line) {
    index_->put(item_of(part), ball_of({as_cut(lines_[part.index].object)->places}, ellipsoid_, false));
  } else if (part.kind == ObjectKind::polygon) {
    const auto shape = as_cut(areas_[part.index].object);
    std::vector<std::vector<Geodetic>> rings = shape->rings;
    if (is_extruded(*shape)) std::ranges::copy(roof_of(*shape).rings, std::back_inserter(rings));
    index_->put(item_of(part), ball_of(rings, ellipsoid_, true));
  } else if (const KeptMesh& mesh = meshes_[part.index]; mesh.object.model) {
    index_->put(item_of(part), {mesh.place_m, batches_.models[mesh.model].reach_m * mesh.object.scale});
  }
}

void LayerObjects::take(PartRef part, ObjectPicker& picker) {
  if (!kept(part).is_shown()) return;
  if (part.kind == ObjectKind::point) {
    const KeptPoint& point = points_[part.index];
    if (point.arrow != LineEnd::none) return;
    picker.point(point.object, point.place_m, point.number);
  } else if (part.kind == ObjectKind::line) {
    KeptLine& line = lines_[part.index];
    if (!line.picked) line.picked = std::make_unique<PickWay>(pick_way(*as_cut(line.object), ellipsoid_));
    picker.line(*line.object, *line.picked, line.number);
  } else if (part.kind == ObjectKind::polygon) {
    KeptArea& area = areas_[part.index];
    if (!area.picked) area.picked = std::make_unique<PickArea>(*as_cut(area.object), ellipsoid_);
    picker.area(*area.object, *area.picked, area.number);
  } else if (part.kind == ObjectKind::mesh) {
    const KeptMesh& mesh = meshes_[part.index];
    picker.mesh(mesh.object, mesh.place_m, batches_.models[mesh.model].reach_m * mesh.object.scale, mesh.number);
  } else {
    const KeptLabel& label = labels_[part.index];
    picker.label(label.object, label.place_m, label.number);
  }
}

// pick_object() lets a later object win at equal distance. So the objects that the index finds are taken in its order.
std::optional<PickedObject> LayerObjects::pick(const View& view, const Ground& ground, glm::dvec2 pixel_px,
                                               const PickOptions& options, std::span<const std::uint32_t> labels) {
  if (!index_) index_all();
  for (const std::uint32_t index : std::exchange(unindexed_, {})) {
    if (!lines_[index].removed) index_part({ObjectKind::line, index});
    lines_[index].unindexed = false;
  }
  std::vector<std::uint32_t> items;
  index_->find(PickCone(view, pixel_px, most_reach_px_ + options.slack_px), items);
  ObjectPicker picker(view, ground, pixel_px, options);
  if (!batches_.ground.empty()) {
    if (const auto* cone = picker.cone_on_ground(most_reach_px_ + options.slack_px)) index_->find(*cone, items);
  }
  std::ranges::sort(items, {}, [](std::uint32_t item) {
    constexpr std::array<std::uint32_t, kKinds> kOrder{3, 1, 0, 2};  // areas, lines, models, points
    return std::pair(kOrder[item % kKinds], item);
  });
  items.erase(std::unique(items.begin(), items.end()), items.end());
  for (const std::uint32_t item : items) take(part_of(item), picker);
  for (const std::uint32_t k : labels) {
    if (k < labels_.size()) take({ObjectKind::label, k}, picker);
  }
  return picker.best();
}

}  // namespace terrella
