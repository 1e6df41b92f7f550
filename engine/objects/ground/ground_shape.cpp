#include "objects/ground/ground_shape.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "geo/great_circle.h"
#include "objects/object_picker.h"

namespace terrella {
namespace {

using glm::dvec2;
using glm::dvec3;

/// Pieces of a run.
constexpr std::uint32_t kMostPieces = 32;
/// Ways of lines are geodesics. On Earth, a great circle of normals of this length leaves one by 0.1 m.
constexpr Angle kGeodesicStep = Angle::degrees(0.35);
/// An area whose corners lie within this of their middle lies within the cap of its corners. 60 degrees.
constexpr double kCosLargestCap = 0.5;
constexpr double kMostRingPieces = 4.0e6;
/// Edges on the map that span less longitude are great circles within kArcTolerance_deg.
constexpr double kShortEdge_deg = 0.05;
constexpr double kLongestEdge_deg = 60.0;  ///< antipodes have no great circle

/// tan(π/4 · kOverFace): how far parts reach in the plane that touches the face.
const double kReach = std::tan(std::numbers::pi / 4.0 * kOverFace);
/// A point of a face's plane within this has no other face within kReach.
const double kAlone = 0.99 / kReach;

double unwarped(double u) { return std::atan(u) * (4.0 / std::numbers::pi); }

/// A direction in the axes of a face: along T, B and N.
dvec3 in_face(const CubeFaceFrame& f, const dvec3& d) { return {glm::dot(d, f.t), glm::dot(d, f.b), glm::dot(d, f.n)}; }
dvec2 on_face(const dvec3& p) { return {unwarped(p.x / p.z), unwarped(p.y / p.z)}; }

/// Cuts pieces at the borders of faces. Both directions of a piece have the same points, to the bit.
class ShapeMaker {
 public:
  explicit ShapeMaker(double from_rad = 0.0) : to_rad_(from_rad) {}

  void piece(const dvec3& a, const dvec3& b, RunUse use) {
    if (a == b) return;
    from_rad_ = to_rad_;
    if (use == RunUse::stroke) to_rad_ += std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    for (int f = 0; f < kCubeFaces; ++f) {
      const CubeFaceFrame& frame = face_frame(static_cast<CubeFace>(f));
      const dvec3 p = in_face(frame, a), q = in_face(frame, b);
      const bool alone = is_alone(p) && is_alone(q);
      if (alone) {
        add(f, on_face(p), on_face(q), use, from_rad_);
        return;
      }
      clip(f, p, q, use);
    }
  }
  /// Says whether the south-west corner of a face's part lies in the area.
  void corner(int face, bool inside) {
    if (inside) add(face, {-kOverFace, -kOverFace}, {-kOverFace, kOverFace}, RunUse::fill);
  }
  [[nodiscard]] static dvec3 corner_of(int face) {
    const CubeFaceFrame& frame = face_frame(static_cast<CubeFace>(face));
    return glm::normalize(frame.n - kReach * frame.t - kReach * frame.b);
  }
  [[nodiscard]] GroundShape take() {
    GroundShape shape;
    for (int f = 0; f < kCubeFaces; ++f) {
      GroundPart& part = parts_[static_cast<std::size_t>(f)];
      if (part.runs.empty()) continue;
      part.face = static_cast<CubeFace>(f);
      for (const GroundRun& run : part.runs) part.box.add(run.box);
      part.points.shrink_to_fit();
      part.runs.shrink_to_fit();
      shape.parts.push_back(std::move(part));
    }
    return shape;
  }

 private:
  static bool is_alone(const dvec3& p) { return std::max(std::abs(p.x), std::abs(p.y)) <= kAlone * p.z; }

  void clip(int f, dvec3 p, dvec3 q, RunUse use) {
    const bool turned = std::pair(p.x, p.y) > std::pair(q.x, q.y);
    if (turned) std::swap(p, q);
    double from = 0.0, to = 1.0;
    bool west_from = false, west_to = false;
    const auto keep = [&](double at_p, double at_q, bool west) {  // the part where the value is positive
      if (at_p < 0.0 && at_q < 0.0) return false;
      if (at_p < 0.0) {
        const double t = at_p / (at_p - at_q);
        if (t > from) from = t, west_from = west;
      } else if (at_q < 0.0) {
        const double t = at_p / (at_p - at_q);
        if (t < to) to = t, west_to = west;
      }
      return from < to;
    };
    if (!keep(kReach * p.z + p.x, kReach * q.z + q.x, true) || !keep(kReach * p.z - p.x, kReach * q.z - q.x, false) ||
        !keep(kReach * p.z + p.y, kReach * q.z + q.y, false) || !keep(kReach * p.z - p.y, kReach * q.z - q.y, false)) {
      return;
    }
    const auto at = [&](double t) { return on_face(t == 0.0 ? p : t == 1.0 ? q : p + t * (q - p)); };
    const dvec2 a = at(from), b = at(to);
    const double begin_rad = glm::mix(from_rad_, to_rad_, turned ? 1.0 - to : from);
    turned ? add(f, b, a, use, begin_rad) : add(f, a, b, use, begin_rad);
    if (use == RunUse::stroke) return;
    // A crossing of the western side changes the inside of that side, north of the crossing.
    if (west_from) add(f, {-kOverFace, a.y}, {-kOverFace, kOverFace}, RunUse::fill);
    if (west_to) add(f, {-kOverFace, b.y}, {-kOverFace, kOverFace}, RunUse::fill);
  }

  void add(int f, const dvec2& a, const dvec2& b, RunUse use, double along_rad = 0.0) {
    GroundPart& part = parts_[static_cast<std::size_t>(f)];
    const bool goes_on = !part.runs.empty() && part.runs.back().use == use && part.points.back() == a;
    if (!goes_on) part.points.push_back(a);
    if (!goes_on || part.runs.back().pieces == kMostPieces) {
      part.runs.push_back(
          {.first = static_cast<std::uint32_t>(part.points.size() - 1), .use = use, .along_rad = along_rad, .box = {}});
      part.runs.back().box.add(a);
    }
    part.points.push_back(b);
    ++part.runs.back().pieces;
    part.runs.back().box.add(b);
  }

  std::array<GroundPart, kCubeFaces> parts_;
  double from_rad_ = 0.0, to_rad_ = 0.0;  ///< lengths of strokes to the ends of the last piece
};

dvec3 normal_of(const Geodetic& place) { return Ellipsoid::normal(place.lat, place.lon).xyz; }
dvec3 normal_of(const MapPoint& p) {
  return Ellipsoid::normal(Angle::degrees(std::clamp(p.lat_deg, -90.0, 90.0)), Angle::degrees(p.lon_deg)).xyz;
}

/// Calls use(a, b) for the pieces of a closed ring.
template <class Use>
void each_piece(const std::vector<Geodetic>& ring, Use use) {
  if (ring.size() < 2) return;
  dvec3 before = normal_of(ring.back());
  for (const Geodetic& place : ring) {
    const dvec3 here = normal_of(place);
    use(before, here);
    before = here;
  }
}

/// True if the area is the smaller part on each side of its rings, and holds no corner of a face's part.
bool is_plain(const PolygonObject& area) {
  dvec3 middle(0.0);
  for (const auto& ring : area.rings) {
    for (const Geodetic& place : ring) middle += normal_of(place);
  }
  if (!(glm::length(middle) > 0.0)) return false;
  middle = glm::normalize(middle);
  double least = 1.0;
  for (const auto& ring : area.rings) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Geodetic& place = ring[k];
      least = std::min(least, glm::dot(middle, normal_of(place)));
      const double turn_deg = std::abs(place.lon.deg() - ring[(k + 1) % ring.size()].lon.deg());
      if (turn_deg > 180.0 && std::abs(turn_deg - 360.0) < 1e-9) return false;  // once round the parallel
    }
  }
  if (!(least > kCosLargestCap)) return false;
  for (int f = 0; f < kCubeFaces; ++f) {
    if (glm::dot(middle, ShapeMaker::corner_of(f)) > least - 1e-9) return false;
  }
  return true;
}

/// Adds an edge of the map as great circles.
void add_map_edge(const MapPoint& a, const MapPoint& b, ShapeMaker& maker, int depth = 0) {
  const MapPoint middle{0.5 * (a.lon_deg + b.lon_deg), 0.5 * (a.lat_deg + b.lat_deg)};
  if (depth < 16 && std::abs(a.lon_deg - b.lon_deg) > kShortEdge_deg) {
    const dvec3 sum = normal_of(a) + normal_of(b);
    if (!(glm::length(glm::cross(sum, normal_of(middle))) <=
          2.0 * glm::dot(sum, normal_of(middle)) * Angle::degrees(kArcTolerance_deg).rad()) ||
        std::abs(a.lon_deg - b.lon_deg) > kLongestEdge_deg) {
      add_map_edge(a, middle, maker, depth + 1);
      add_map_edge(middle, b, maker, depth + 1);
      return;
    }
  }
  maker.piece(normal_of(a), normal_of(b), RunUse::fill);
}

/// Adds the edges of an area over a pole, of more than 60 degrees, or at a corner of a face.
FillFault add_rings(const PolygonObject& area, ShapeMaker& maker) {
  double pieces = 0.0;
  for (const auto& ring : area.rings) {
    std::vector<MapPoint> places;
    for (const Geodetic& p : ring) places.push_back({p.lon.deg(), std::clamp(p.lat.deg(), -90.0, 90.0)});
    pieces += pieces_of(places);
    if (!(pieces <= kMostRingPieces)) return FillFault::invalid;
  }
  const std::optional<std::vector<MapRing>> rings = map_rings_of(area);
  if (!rings) return FillFault::invalid;
  for (const MapRing& ring : *rings) {
    for (std::size_t k = 0; k < ring.size(); ++k) add_map_edge(ring[k], ring[(k + 1) % ring.size()], maker);
  }
  for (int f = 0; f < kCubeFaces; ++f) {
    const Geodetic place = Ellipsoid::lat_lon(EcefDir{ShapeMaker::corner_of(f)});
    bool inside = false;
    for (const MapRing& ring : *rings) inside = inside != crosses_odd(ring, {place.lon.deg(), place.lat.deg()});
    maker.corner(f, inside);
  }
  return FillFault::none;
}

}  // namespace

GroundShape ground_shape(const LineObject& line, const Ellipsoid& ellipsoid, double from_rad) {
  ShapeMaker maker(from_rad);
  const std::vector<EcefDir> way = normals_along_geodesics(line.places, ellipsoid, kGeodesicStep);
  for (std::size_t k = 1; k < way.size(); ++k) maker.piece(way[k - 1].xyz, way[k].xyz, RunUse::stroke);
  return maker.take();
}

GroundShape ground_shape(const PolygonObject& area, bool fill) {
  ShapeMaker maker;
  const bool plain = fill && is_plain(area);
  FillFault fault = FillFault::none;
  if (fill && !plain) fault = add_rings(area, maker);
  for (const auto& ring : area.rings) {
    each_piece(ring, [&](const dvec3& a, const dvec3& b) { maker.piece(a, b, plain ? RunUse::both : RunUse::stroke); });
  }
  GroundShape shape = maker.take();
  shape.fault = fault;
  return shape;
}

}  // namespace terrella
