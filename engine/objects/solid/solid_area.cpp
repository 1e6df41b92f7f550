#include "objects/solid/solid_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "geo/split_position.h"
#include "objects/ground/on_ground.h"
#include "objects/object_picker.h"

namespace terrella {
namespace {

using glm::dvec3;

/// Places along the edges at which the ground is looked at: steps of about 600 m on Earth, or this many in a ring.
constexpr double kStepsOfALine = 8.0, kMostSteps = 1024.0;
/// Ground between these places may be lower, by this part of its range.
constexpr double kUnseenShare = 0.1;

struct Range_m {
  double least = HUGE_VAL, most = -HUGE_VAL;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

Range_m ground_under(const PolygonObject& area, const Ground& ground) {
  const Ellipsoid& e = ground.ellipsoid();
  Range_m range;
  for (const auto& ring : area.rings) {
    const Angle step = std::max((1.0 / kStepsOfALine) * kLineStep, (1.0 / kMostSteps) * length_of(ring));
    for (const dvec3& at_m : outline(ring, e, step, 0.0)) {
      const Geodetic place = e.to_geodetic(Ecef{at_m});
      range.add(ground.height_m(place.lat, place.lon));
    }
  }
  return range;
}

void set_height(PolygonObject& area, double height_m) {
  for (auto& ring : area.rings) {
    for (Geodetic& place : ring) place.height_m = height_m;
  }
}

dvec3 up_at(const Ellipsoid& ellipsoid, const dvec3& at_m) {
  const Geodetic place = ellipsoid.to_geodetic(Ecef{at_m});
  return Ellipsoid::normal(place.lat, place.lon).xyz;
}

void put(std::vector<SolidVertex>& out, const dvec3& at_m, const dvec3& normal) {
  const SplitPosition p = split_position(at_m);
  out.push_back({p.high, p.low, glm::vec3(normal), {}});
}

/// True if what a ring encloses lies to the left of a way along it. Its longest piece is looked at, a little beside it.
bool is_left(const PickArea& enclosed, const std::vector<dvec3>& way, const Ellipsoid& ellipsoid) {
  std::size_t longest = 0;
  const auto length = [&way](std::size_t k) { return glm::distance(way[k], way[k + 1]); };
  for (std::size_t k = 1; k + 1 < way.size(); ++k) longest = length(k) > length(longest) ? k : longest;
  const dvec3 middle_m = 0.5 * (way[longest] + way[longest + 1]);
  constexpr double kBeside = 0.01;
  const dvec3 off_m = kBeside * glm::cross(up_at(ellipsoid, middle_m), way[longest + 1] - way[longest]);
  const Geodetic beside = ellipsoid.to_geodetic(Ecef{middle_m + off_m});
  return enclosed.covers({beside.lon.deg(), beside.lat.deg()});
}

/// Appends the walls under the edge of a roof. The area lies to the left of the way.
void put_walls(const std::vector<dvec3>& way, double depth_m, const Ellipsoid& ellipsoid,
               std::vector<SolidVertex>& out) {
  dvec3 up = up_at(ellipsoid, way.front());
  for (std::size_t k = 0; k + 1 < way.size(); ++k) {
    const dvec3 &a_m = way[k], &b_m = way[k + 1], next_up = up_at(ellipsoid, b_m);
    const dvec3 below_a_m = a_m - depth_m * up, below_b_m = b_m - depth_m * next_up;
    const dvec3 normal = glm::normalize(glm::cross(b_m - a_m, up + next_up));
    for (const dvec3& corner_m : {below_a_m, below_b_m, b_m, below_a_m, b_m, a_m}) put(out, corner_m, normal);
    up = next_up;
  }
}

}  // namespace

PolygonObject standing_shape(PolygonObject area, const Ground& ground) {
  if (area.heights == HeightMode::absolute) return area;
  const Range_m under = ground_under(area, ground);
  Range_m over;
  for (auto& ring : area.rings) {
    for (Geodetic& place : ring) {
      over.add(area.heights == HeightMode::relative_to_ground ? place.height_m : 0.0);
      place = over_ground(place, area.heights, ground);
    }
  }
  if (!(under.least <= under.most)) return area;
  const double roof_m = mean_height_m(area) + area.extrude_m;
  const double foot_m = under.least - kUnseenShare * (under.most - under.least) + over.least;
  set_height(area, foot_m);
  area.heights = HeightMode::absolute;
  area.extrude_m = roof_m - foot_m;
  return area;
}

PolygonObject roof_of(PolygonObject area) {
  set_height(area, mean_height_m(area) + area.extrude_m);
  area.extrude_m = 0.0;
  return area;
}

std::vector<SolidVertex> solid_of(const PolygonObject& area, const FillMesh& roof, const Ellipsoid& ellipsoid,
                                  Angle step) {
  std::vector<SolidVertex> out;
  for (const std::uint32_t index : roof.indices) {
    const dvec3& at_m = roof.positions_m[index];
    put(out, at_m, up_at(ellipsoid, at_m));
  }
  const PolygonObject top = roof_of(area);
  for (const auto& ring : top.rings) {
    std::vector<dvec3> way = outline(ring, ellipsoid, step, roof.lift_m);
    if (way.size() < 3) continue;
    // The first ring encloses the area, the others are holes. A search in all rings would take the square of their
    // number.
    const bool encloses = &ring == &top.rings.front();
    if (is_left(PickArea({.rings = {ring}}, ellipsoid), way, ellipsoid) != encloses) std::ranges::reverse(way);
    put_walls(way, area.extrude_m + roof.lift_m, ellipsoid, out);
  }
  return out;
}

}  // namespace terrella
