#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "objects/layer_objects.h"
#include "objects/object_shapes.h"

// The objects of a layer in its batches.
namespace terrella {
namespace {

/// Directions of a model's x (left), y (up) and z (forward) at its place. Each is as long as a metre of the model.
std::array<glm::vec3, 3> axes_of(const MeshObject& mesh) {
  const glm::dvec3 up = Ellipsoid::normal(mesh.place.lat, mesh.place.lon).xyz;
  const glm::dvec3 forward = level_direction(mesh.place, mesh.heading), left = glm::cross(up, forward);
  return {glm::vec3(mesh.scale * left), glm::vec3(mesh.scale * up), glm::vec3(mesh.scale * forward)};
}

// A selected object with a picture of its own keeps some of it.
ObjectColor wash_of(ObjectColor selected) {
  constexpr std::uint8_t kMixed = 150;
  return {selected.red, selected.green, selected.blue, kMixed};
}

template <class T>
std::vector<T> copy_of(std::span<const T> items) {
  return {items.begin(), items.end()};
}

}  // namespace

// Hidden objects lie in the bucket of their own colour, so that they show in their place again.
std::size_t LayerObjects::bucket_of(bool underground, const ObjectColor& color, bool chosen) const {
  const bool opaque = color.alpha == 255 && opacity_ == 1.0;
  return Batch<char>::bucket(underground ? ObjectPart::underground : ObjectPart::above_ground, opaque, chosen);
}

DotInstance LayerObjects::dot(const KeptPoint& point) const {
  const PointObject& object = point.object;
  const SplitPosition p = split_position(point.place_m);
  const float size = object.radius_m > 0.0 ? static_cast<float>(object.radius_m) : object.size_px;
  return {p.high, p.low, size, drawn(object.color, point)};
}

std::size_t LayerObjects::bucket_of(const KeptPoint& point) const {
  const PointObject& object = point.object;
  return bucket_of(is_underground(object), is_icon(object) ? object.icon.tint : object.color, object.through_surface);
}

std::size_t LayerObjects::bucket_of(const KeptLine& line) const {
  return bucket_of(is_underground(*line.object), line.object->color, line.object->through_surface);
}

std::size_t LayerObjects::casing_bucket(const KeptLine& line) const {
  return bucket_of(is_underground(*line.object), line.object->casing, line.object->through_surface);
}

std::size_t LayerObjects::outline_bucket(const KeptArea& area) const {
  return bucket_of(is_underground(*area.object), area.object->stroke, area.object->through_surface);
}

std::size_t LayerObjects::fill_bucket(const KeptArea& area) const {
  return bucket_of(is_underground(*area.object), area.object->fill, area.object->through_surface);
}

IconInstance LayerObjects::icon(const KeptPoint& point) const {
  const PointIcon& icon = point.object.icon;
  const SplitPosition p = split_position(point.place_m);
  IconInstance item{p.high, p.low, {}, icon.anchor, point.object.size_px, point.image, icon.tint};
  if (icon.from_north) {
    item.up = glm::vec4(glm::vec3(level_direction(point.object.place, icon.heading)), 0.0F);
  } else {
    item.up = glm::vec4(std::sin(icon.heading.rad()), std::cos(icon.heading.rad()), 0.0, 1.0);
  }
  const ObjectColor color = drawn(icon.tint, point);
  if (point.arrow != LineEnd::none) {
    item.color = color;
    if (!point.has_direction) item.color.alpha = 0;
    return item;
  }
  item.color.alpha = color.alpha;
  if (point.selected) item.wash = wash_of(selected_color_);
  return item;
}

void LayerObjects::draw_icon(KeptPoint& point) {
  batches_.icons_below_px = std::max(batches_.icons_below_px, static_cast<float>(below_px(point.object)));
  const std::size_t bucket = bucket_of(point);
  if (point.slot.count > 0 && point.slot.bucket == bucket) {
    batches_.icons.change(point.slot).front() = icon(point);
    return;
  }
  if (point.slot.count == 0) {
    auto& images = batches_.icon_images;
    const auto found = std::ranges::find(images, point.object.icon.image);
    point.image = static_cast<std::uint32_t>(found - images.begin());
    if (found == images.end()) images.push_back(point.object.icon.image);
  }
  batches_.icons.drop(point.slot);
  const IconInstance item = icon(point);
  point.slot = batches_.icons.add(bucket, std::span(&item, 1));
}

void LayerObjects::draw(KeptPoint& point) {
  if (is_icon(point.object)) return draw_icon(point);
  const std::size_t bucket = bucket_of(point);
  const bool in_place = point.slot.count > 0 && point.slot.bucket == bucket;
  if (point.object.radius_m > 0.0) {
    SphereBatch& spheres = batches_.spheres;
    spheres.stale = spheres.stale || !in_place;
    if (spheres.stale) return;
    spheres.groups.set(point.slot.first, dot(point));
    spheres.changed.note(point.slot.first, 1);
    return;
  }
  const DotInstance item = dot(point);
  if (in_place) {
    batches_.markers.change(point.slot).front() = item;
    return;
  }
  batches_.markers.drop(point.slot);
  point.slot = batches_.markers.add(bucket, std::span(&item, 1));
}

void LayerObjects::drop(PartRef part) {
  if (part.kind == ObjectKind::point) {
    KeptPoint& point = points_[part.index];
    if (point.object.radius_m > 0.0) {
      batches_.spheres.stale = true;
    } else if (is_icon(point.object)) {
      batches_.icons.drop(point.slot);
    } else {
      batches_.markers.drop(point.slot);
    }
  } else if (part.kind == ObjectKind::line) {
    put_on_ground(lines_[part.index].ground, {});
    batches_.lines.drop(lines_[part.index].slot);
    batches_.casings.drop(lines_[part.index].casing);
  } else if (part.kind == ObjectKind::polygon) {
    KeptArea& area = areas_[part.index];
    const bool extruded = is_extruded(*area.object);
    triangles_ -= (extruded ? area.fill : area.triangles).count / 3;
    area.triangles = {};
    put_on_ground(area.ground, {});
    batches_.lines.drop(area.outline);
    extruded ? batches_.solids.drop(area.fill) : batches_.fill_vertices.drop(area.fill);
  } else if (part.kind == ObjectKind::mesh && meshes_[part.index].object.model) {
    batches_.models[meshes_[part.index].model].stands.drop(meshes_[part.index].slot);
  } else if (part.kind == ObjectKind::label) {
    --label_counts_[is_underground(labels_[part.index].object) ? 1 : 0];
    ++label_version_;
  }
}

void LayerObjects::sort_spheres() {
  SphereBatch& spheres = batches_.spheres;
  std::array<std::vector<std::uint32_t>, Batch<char>::kBuckets> buckets;
  for (std::uint32_t k = 0; k < points_.size(); ++k) {
    const PointObject& object = points_[k].object;
    if (object.radius_m <= 0.0 || points_[k].removed) continue;
    buckets[bucket_of(points_[k])].push_back(k);
  }
  Batch<DotInstance> batch;
  std::vector<std::uint32_t> points;
  for (std::size_t bucket = 0; bucket < buckets.size(); ++bucket) {
    batch.first[bucket] = points.size();
    for (const std::uint32_t k : buckets[bucket]) {
      batch.items.push_back(dot(points_[k]));
      points.push_back(k);
      points_[k].slot.bucket = static_cast<std::uint8_t>(bucket);
      points_[k].slot.count = 1;
    }
  }
  batch.first.back() = points.size();
  spheres.ranges.first = batch.first;
  spheres.groups = SphereGroups(batch);
  for (std::uint32_t k = 0; k < points.size(); ++k) points_[points[spheres.groups.source(k)]].slot.first = k;
  spheres.changed.forget();
  spheres.changed.note(0, points.size());
  spheres.stale = false;
}

MeshStand LayerObjects::stand(const KeptMesh& mesh) const {
  const SplitPosition p = split_position(mesh.place_m);
  MeshStand stand{p.high, p.low, {}};
  if (mesh.is_shown()) stand.ecef_from_model = axes_of(mesh.object);
  if (mesh.selected) stand.tint = wash_of(selected_color_);
  return stand;
}

void LayerObjects::draw(KeptMesh& mesh) {
  if (!mesh.object.model) return;
  auto& models = batches_.models;
  if (mesh.slot.count == 0) {
    const auto found = std::ranges::find(models, mesh.object.model, &ModelStands::model);
    mesh.model = static_cast<std::size_t>(found - models.begin());
    if (found == models.end()) models.push_back({mesh.object.model, reach_m(*mesh.object.model), {}});
  }
  SlotBatch<MeshStand>& stands = models[mesh.model].stands;
  const ObjectPart part = is_underground(mesh.object) ? ObjectPart::underground : ObjectPart::above_ground;
  // Each part of a model states its own opacity.
  const std::size_t bucket = Batch<char>::bucket(part, true, mesh.object.through_surface);
  const MeshStand item = stand(mesh);
  if (mesh.slot.count > 0 && mesh.slot.bucket == bucket) {
    stands.change(mesh.slot).front() = item;
    return;
  }
  stands.drop(mesh.slot);
  mesh.slot = stands.add(bucket, std::span(&item, 1));
}

void LayerObjects::color_line(SlotBatch<LineVertex>& lines, Slot& slot, std::size_t bucket, const ObjectColor& color,
                              float width_px) {
  if (slot.count == 0) return;
  if (slot.bucket != bucket) {
    const std::vector<LineVertex> vertices = copy_of(lines.at(slot));
    lines.drop(slot);
    slot = lines.add(bucket, vertices);
  }
  for (LineVertex& vertex : lines.change(slot)) {
    vertex.color = color;
    if (vertex.width_px != 0.0F) vertex.width_px = width_px;
  }
}

void LayerObjects::draw(KeptLine& line) {
  const LineObject& object = *line.object;
  if (line.ground.shape) {
    return put_on_ground(line.ground,
                         {.shape = line.ground.shape,
                          .line = drawn(object.color, line),
                          .width_px = object.width_px,
                          .dashes = object.dashes,
                          .casing = has_casing(object) ? drawn(object.casing, line) : ObjectColor{0, 0, 0, 0},
                          .casing_px = object.casing_px});
  }
  color_line(batches_.casings, line.casing, casing_bucket(line), drawn(object.casing, line),
             object.width_px + 2.0F * object.casing_px);
  color_line(batches_.lines, line.slot, bucket_of(line), drawn(object.color, line), object.width_px);
}

void LayerObjects::draw(KeptArea& area) {
  const PolygonObject& object = *area.object;
  if (area.ground.shape) {
    const ObjectColor none{0, 0, 0, 0};
    return put_on_ground(area.ground, {.shape = area.ground.shape,
                                       .fill = area.asked_fill ? drawn(object.fill, area) : none,
                                       .line = drawn(object.stroke, area),
                                       .width_px = object.stroke_width_px});
  }
  color_line(batches_.lines, area.outline, outline_bucket(area), drawn(object.stroke, area), object.stroke_width_px);
  if (area.fill.count == 0) return;
  if (is_extruded(object)) return draw_solid(area);
  if (area.fill.bucket != fill_bucket(area)) {
    const std::vector<FillVertex> vertices = copy_of(batches_.fill_vertices.at(area.fill));
    std::vector<std::uint32_t> triangles = own_triangles(batches_, area);
    batches_.fill_vertices.drop(area.fill);
    put_fill(area, vertices, std::move(triangles));
  }
  const ObjectColor color = drawn(object.fill, area);
  for (FillVertex& vertex : batches_.fill_vertices.change(area.fill)) vertex.color = color;
}

}  // namespace terrella
