#include "apps/viewer/draw/drawing_scene.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

namespace terrella {
namespace {

constexpr HeightMode kOnGround = HeightMode::clamp_to_ground;
constexpr float kPlace_px = 10.0F;

ObjectIdentity identity_of(const DrawnMark& mark) {
  const nlohmann::json properties = mark.name.empty() ? nlohmann::json::object() : nlohmann::json{{"title", mark.name}};
  auto feature = std::make_shared<ObjectFeature>();
  feature->properties = properties.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return {.id = mark.id, .feature = std::move(feature)};
}

void add_mark(const DrawnMark& mark, float scale, ObjectScene& scene) {
  const ObjectIdentity of = identity_of(mark);
  const MarkLook& look = mark.look;
  const bool is_place = mark.kind == MarkKind::place;
  if (is_place) {
    scene.points.push_back({.place = mark.places.front(),
                            .size_px = scale * kPlace_px,
                            .color = look.color,
                            .of = of,
                            .heights = kOnGround});
  } else if (mark.kind == MarkKind::line) {
    scene.lines.push_back({.places = mark.places,
                           .width_px = scale * look.width_px,
                           .color = look.color,
                           .of = of,
                           .heights = kOnGround});
  } else {
    scene.polygons.push_back({.rings = {mark.places},
                              .fill = look.fill,
                              .stroke = look.color,
                              .stroke_width_px = scale * look.width_px,
                              .of = of,
                              .heights = kOnGround});
  }
  if (mark.name.empty()) return;
  scene.labels.push_back({.text = mark.name,
                          .place = is_place ? mark.places.front() : middle_of(mark),
                          .size_px = is_place ? scale * kPlace_px : 0.0F,
                          .priority = 1.0,
                          .of = of,
                          .heights = kOnGround});
}

std::string name_of(const ObjectIdentity& of) {
  if (!of.feature) return {};
  const nlohmann::json properties = nlohmann::json::parse(of.feature->properties, nullptr, false);
  if (!properties.is_object()) return {};
  for (const char* name : {"title", "name"}) {
    const auto found = properties.find(name);
    if (found != properties.end() && found->is_string() && !found->get_ref<const std::string&>().empty())
      return found->get<std::string>();
  }
  return {};
}

DrawnMark mark_of(const ObjectIdentity& of, MarkKind kind, std::vector<Geodetic> places, const MarkLook& look) {
  for (Geodetic& place : places) {
    place.lon = Angle::degrees(std::remainder(place.lon.deg(), 360.0));
    place.height_m = 0.0;
  }
  return {.id = of.id, .kind = kind, .places = std::move(places), .name = name_of(of), .look = look};
}

/// Adds a mark if an object can be one; else counts the object.
void take_mark(SceneDrawing& taken, bool can_be, DrawnMark mark) {
  if (can_be && check_mark(mark)) {
    taken.drawing.marks.push_back(std::move(mark));
  } else {
    ++taken.left_out;
  }
}

}  // namespace

ObjectScene drawing_scene(const Drawing& drawing, float scale) {
  ObjectScene scene;
  for (const DrawnMark& mark : drawing.marks) add_mark(mark, scale, scene);
  return scene;
}

ObjectEdits drawing_edits(const Drawing& before, const Drawing& after, float scale) {
  ObjectEdits edits;
  for (const DrawnMark& mark : before.marks) {
    const DrawnMark* now = after.find(mark.id);
    if (now == nullptr || *now != mark) edits.remove.push_back(mark.id);
  }
  for (const DrawnMark& mark : after.marks) {
    const DrawnMark* was = before.find(mark.id);
    if (was == nullptr || *was != mark) add_mark(mark, scale, edits.add);
  }
  return edits;
}

SceneDrawing drawing_of(const ObjectScene& scene) {
  SceneDrawing taken;
  taken.left_out = scene.meshes.size();
  for (const PointObject& point : scene.points) {
    const bool is_marker = point.radius_m == 0.0 && !point.icon.image;
    take_mark(taken, is_marker, mark_of(point.of, MarkKind::place, {point.place}, {.color = point.color}));
  }
  for (const LineObject& line : scene.lines) {
    take_mark(taken, true,
              mark_of(line.of, MarkKind::line, line.places, {.color = line.color, .width_px = line.width_px}));
  }
  for (const PolygonObject& area : scene.polygons) {
    const MarkLook look{.color = area.stroke, .width_px = area.stroke_width_px, .fill = area.fill};
    const bool is_plain = area.rings.size() == 1 && !is_extruded(area);
    take_mark(taken, is_plain,
              mark_of(area.of, MarkKind::area, is_plain ? area.rings[0] : std::vector<Geodetic>(), look));
  }
  auto& marks = taken.drawing.marks;
  std::ranges::stable_sort(marks, {}, &DrawnMark::id);
  for (std::size_t k = 0; k < marks.size(); ++k) marks[k].id = ObjectId{k + 1};  // parts of one feature come apart
  return taken;
}

}  // namespace terrella
