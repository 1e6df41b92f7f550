#include "objects/object_picker.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <utility>

#include "geo/great_circle.h"
#include "objects/object_shapes.h"
#include "objects/solid/solid_area.h"

namespace terrella {
namespace {

// Distances that differ by at most this fraction count as equal.
constexpr double kSameDistance = 0.01;
constexpr double kMostPickPieces = 2048.0;

Angle pick_step(const std::vector<Geodetic>& places) {
  return std::max(kLineStep, Angle::radians(length_of(places).rad() / kMostPickPieces));
}

}  // namespace

bool crosses_odd(const MapRing& ring, const MapPoint& p) {
  bool odd = false;
  for (std::size_t k = 0, before = ring.size() - 1; k < ring.size(); before = k++) {
    const MapPoint &a = ring[before], &b = ring[k];
    if ((a.lat_deg > p.lat_deg) == (b.lat_deg > p.lat_deg)) continue;
    const double lon = a.lon_deg + (p.lat_deg - a.lat_deg) / (b.lat_deg - a.lat_deg) * (b.lon_deg - a.lon_deg);
    if (p.lon_deg < lon) odd = !odd;
  }
  return odd;
}

std::optional<std::vector<MapRing>> map_rings_of(const PolygonObject& polygon) {
  std::vector<MapRing> all;
  for (const auto& ring : polygon.rings) {
    std::vector<MapPoint> positions;
    positions.reserve(ring.size());
    for (const Geodetic& place : ring) positions.push_back({place.lon.deg(), place.lat.deg()});
    Result<std::vector<MapRing>> rings = rings_of(positions);
    if (!rings) return std::nullopt;
    for (MapRing& closed : *rings) all.push_back(std::move(closed));
  }
  return all;
}

PickWay::PickWay(std::vector<glm::dvec3> places) : places_m(std::move(places)) {
  for (std::size_t first = 0; first + 1 < places_m.size(); first += kRun) {
    const std::size_t last = std::min(first + kRun, places_m.size() - 1);
    Ball ball{places_m[first + (last - first) / 2], 0.0};
    for (std::size_t k = first; k <= last; ++k) {
      ball.radius_m = std::max(ball.radius_m, glm::length(places_m[k] - ball.center_m));
    }
    runs.push_back(ball);
  }
}

PickWay pick_way(const LineObject& line, const Ellipsoid& ellipsoid) {
  return PickWay(line_along_geodesics(line.places, ellipsoid, pick_step(line.places)));
}

PickArea::PickArea(const PolygonObject& polygon, const Ellipsoid& ellipsoid)
    : rings(map_rings_of(polygon).value_or(std::vector<MapRing>())),
      height_m(mean_height_m(polygon)),
      depth_m(is_extruded(polygon) ? polygon.extrude_m : 0.0) {
  height_m += depth_m;
  for (const auto& ring : depth_m > 0.0 ? roof_of(polygon).rings : polygon.rings) {
    outlines.emplace_back(outline(ring, ellipsoid, pick_step(ring), 0.0));
  }
  box = bounds_of(rings);
}

bool PickArea::covers(const MapPoint& p) const {
  if (p.lon_deg < box.west_deg || p.lon_deg > box.east_deg || p.lat_deg < box.south_deg || p.lat_deg > box.north_deg) {
    return false;
  }
  bool in = false;
  for (const MapRing& ring : rings) in = in != crosses_odd(ring, p);
  return in;
}

double reach_m(const MeshModel& model) {
  float reach_m = 0.0F;
  for (const MeshPart& part : model.parts) {
    for (const MeshVertex& vertex : part.vertices) reach_m = std::max(reach_m, glm::length(vertex.position_m));
  }
  return double(reach_m);
}

glm::dvec2 icon_sides_px(const PointObject& icon) {
  const glm::dvec2 picture(icon.icon.image->width_px, icon.icon.image->height_px);
  return picture * (double(icon.size_px) / std::max(picture.x, picture.y));
}

double reach_px(const PointObject& marker) {
  if (!is_icon(marker)) return 0.5 * double(marker.size_px);
  const glm::dvec2 anchor(marker.icon.anchor);
  return glm::length(glm::max(glm::abs(anchor), glm::abs(1.0 - anchor)) * icon_sides_px(marker));
}

double below_px(const PointObject& icon) {
  if (icon.icon.from_north || icon.icon.heading != Angle{}) return reach_px(icon);
  return std::max(0.0, (1.0 - double(icon.icon.anchor.y)) * icon_sides_px(icon).y);
}

// At equal distance, a later object wins.
void ObjectPicker::take(ObjectKind kind, std::size_t index, const ObjectIdentity& of, const glm::dvec3& at_m) {
  const double distance = glm::length(at_m - view_.eye.xyz_m);
  if (best_ && distance > best_->distance_m * (1.0 + kSameDistance)) return;
  if (hidden(at_m)) return;
  best_ = PickedObject{kind, index, distance, of};
}

// The far side begins beyond the point of the line of sight that is nearest to the centre.
bool ObjectPicker::hidden(const glm::dvec3& at_m) const {
  if (!options_.through_ground) return hidden_by_ground(view_, ground_, Ecef{at_m});
  const glm::dvec3 way = at_m - view_.eye.xyz_m;
  return glm::dot(at_m, way) > 0.0 && hidden_by_ground(view_, Ground(ground_.ellipsoid()), Ecef{at_m});
}

void ObjectPicker::sphere(ObjectKind kind, std::size_t index, const ObjectIdentity& of, const Ball& ball) {
  const glm::dvec3 to_center = ball.center_m - view_.eye.xyz_m;
  const double along = glm::dot(to_center, ray_);
  const double inside2 = ball.radius_m * ball.radius_m - (glm::dot(to_center, to_center) - along * along);
  if (!(along > 0.0 && inside2 >= 0.0)) return;
  take(kind, index, of, view_.eye.xyz_m + ray_ * (along - std::sqrt(inside2)));
}

void ObjectPicker::point(const PointObject& point, const glm::dvec3& place_m, std::size_t index) {
  if (point.radius_m > 0.0) return sphere(ObjectKind::point, index, point.of, {place_m, point.radius_m});
  const auto at = project(view_, Ecef{place_m});
  if (!at) return;
  if (is_icon(point) ? !in_icon(point, place_m, *at)
                     : !(glm::length(*at - pixel_px_) <= 0.5 * double(point.size_px) + options_.slack_px)) {
    return;
  }
  take(ObjectKind::point, index, point.of, place_m);
}

// The icon's rectangle, widened as markers are.
bool ObjectPicker::in_icon(const PointObject& icon, const glm::dvec3& place_m, const glm::dvec2& at_px) const {
  glm::dvec2 up(std::sin(icon.icon.heading.rad()), -std::cos(icon.icon.heading.rad()));  // pixels, y down
  if (icon.icon.from_north) {
    const double step_m = 1e-5 * glm::length(place_m - view_.eye.xyz_m);
    const auto ahead = project(view_, Ecef{place_m + step_m * level_direction(icon.place, icon.icon.heading)});
    if (!ahead || *ahead == at_px) return false;
    up = glm::normalize(*ahead - at_px);
  }
  const glm::dvec2 off = pixel_px_ - at_px, right(-up.y, up.x), sides = icon_sides_px(icon);
  const glm::dvec2 in = glm::dvec2(glm::dot(off, right), -glm::dot(off, up)) + glm::dvec2(icon.icon.anchor) * sides;
  return glm::all(glm::greaterThanEqual(in, glm::dvec2(-options_.slack_px))) &&
         glm::all(glm::lessThanEqual(in, sides + options_.slack_px));
}

void ObjectPicker::mesh(const MeshObject& mesh, const glm::dvec3& place_m, double radius_m, std::size_t index) {
  sphere(ObjectKind::mesh, index, mesh.of, {place_m, radius_m});
}

void ObjectPicker::line(const LineObject& line, const PickWay& way, std::size_t index) {
  const auto find = is_draped(line) ? &ObjectPicker::along_ground : &ObjectPicker::along;
  (this->*find)(ObjectKind::line, index, line.of, way, line.width_px);
}

void ObjectPicker::label(const LabelObject& label, const glm::dvec3& place_m, std::size_t index) {
  take(ObjectKind::label, index, label.of, place_m);
}

void ObjectPicker::along(ObjectKind kind, std::size_t index, const ObjectIdentity& of, const PickWay& way,
                         float width_px) {
  const double reach_px = 0.5 * double(width_px) + options_.slack_px;
  const PickCone cone(view_, pixel_px_, reach_px);
  for (std::size_t run = 0; run < way.runs.size(); ++run) {
    if (!cone.meets(way.runs[run].center_m, way.runs[run].radius_m)) continue;
    const std::size_t end = std::min((run + 1) * PickWay::kRun, way.places_m.size() - 1);
    for (std::size_t k = run * PickWay::kRun; k < end; ++k) {
      const glm::dvec3 &from_m = way.places_m[k], &to_m = way.places_m[k + 1];
      const auto a = project(view_, Ecef{from_m}), b = project(view_, Ecef{to_m});
      if (!a || !b) continue;
      const glm::dvec2 side = *b - *a;
      const double part = std::clamp(glm::dot(pixel_px_ - *a, side) / std::max(glm::dot(side, side), 1e-12), 0.0, 1.0);
      if (!(glm::length(*a + part * side - pixel_px_) <= reach_px)) continue;
      take(kind, index, of, from_m + part * (to_m - from_m));
    }
  }
}

const std::optional<Geodetic>& ObjectPicker::place() {
  if (!std::exchange(looked_, true)) place_ = pick(view_, ground_, pixel_px_);
  return place_;
}

// Ground that faces the eye is seen less slanted than the ellipsoid under it.
const PickCone* ObjectPicker::cone_on_ground(double reach_px) {
  if (!place()) return nullptr;
  constexpr double kSlant = 16.0;
  View lowered = view_;
  lowered.eye.xyz_m -= place()->height_m * Ellipsoid::normal(place()->lat, place()->lon).xyz;
  return &cone_.emplace(lowered, pixel_px_, kSlant * reach_px);
}

// True if the ground at a place of the ellipsoid is drawn within reach of the pixel.
bool ObjectPicker::reaches(const glm::dvec3& place_m, double reach_px, glm::dvec3& at_m) const {
  Geodetic on_ground = ground_.ellipsoid().to_geodetic(Ecef{place_m});
  on_ground.height_m = ground_.height_m(on_ground.lat, on_ground.lon);
  const Ecef at = ground_.ellipsoid().to_ecef(on_ground);
  const auto px = project(view_, at);
  at_m = at.xyz_m;
  return px && glm::length(*px - pixel_px_) <= reach_px;
}

// Two places of a piece count: the nearest to the ground under the pixel, and the one straight before or behind it.
void ObjectPicker::along_ground(ObjectKind kind, std::size_t index, const ObjectIdentity& of, const PickWay& way,
                                float width_px) {
  const double reach_px = 0.5 * double(width_px) + options_.slack_px;
  const PickCone* cone = cone_on_ground(reach_px);
  if (cone == nullptr) return;
  const glm::dvec3 foot_m = ground_.ellipsoid().to_ecef({.lat = place_->lat, .lon = place_->lon}).xyz_m;
  const glm::dvec3 beside = glm::cross(ray_, Ellipsoid::normal(place_->lat, place_->lon).xyz);
  for (std::size_t run = 0; run < way.runs.size(); ++run) {
    if (!cone->meets(way.runs[run].center_m, way.runs[run].radius_m)) continue;
    const std::size_t end = std::min((run + 1) * PickWay::kRun, way.places_m.size() - 1);
    for (std::size_t k = run * PickWay::kRun; k < end; ++k) {
      const glm::dvec3 from_m = way.places_m[k], piece_m = way.places_m[k + 1] - from_m, to_m = foot_m - from_m;
      for (const double part : {glm::dot(to_m, piece_m) / std::max(glm::dot(piece_m, piece_m), 1e-12),
                                glm::dot(to_m, beside) / glm::dot(piece_m, beside)}) {
        glm::dvec3 at_m;
        if (!std::isfinite(part) || !reaches(from_m + std::clamp(part, 0.0, 1.0) * piece_m, reach_px, at_m)) continue;
        take(kind, index, of, at_m);
        break;
      }
    }
  }
}

// The fill lies at one height, so the ray is intersected with the body raised by that height.
void ObjectPicker::area(const PolygonObject& polygon, const PickArea& area, std::size_t index) {
  const bool draped = is_draped(polygon);
  if (polygon.stroke.alpha > 0) {
    const auto find = draped ? &ObjectPicker::along_ground : &ObjectPicker::along;
    for (const PickWay& way : area.outlines) {
      (this->*find)(ObjectKind::polygon, index, polygon.of, way, polygon.stroke_width_px);
    }
  }
  if (polygon.fill.alpha == 0) return;
  if (draped) {
    if (place() && area.covers({place()->lon.deg(), place()->lat.deg()})) {
      take(ObjectKind::polygon, index, polygon.of, ground_.ellipsoid().to_ecef(*place()).xyz_m);
    }
    return;
  }
  if (area.depth_m > 0.0) walls(polygon, area, index);
  const Ellipsoid& e = ground_.ellipsoid();
  const double a_m = e.a_m() + area.height_m, b_m = e.b_m() + area.height_m;
  const auto distance = Ellipsoid(a_m, 1.0 - b_m / a_m).intersect_m(view_.eye, EcefDir{ray_});
  if (!distance) return;
  const glm::dvec3 at_m = view_.eye.xyz_m + *distance * ray_;
  const Geodetic place = e.to_geodetic(Ecef{at_m});
  if (area.covers({place.lon.deg(), place.lat.deg()})) take(ObjectKind::polygon, index, polygon.of, at_m);
}

}  // namespace terrella
