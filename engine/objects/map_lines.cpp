#include "objects/map_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

namespace terrella {
namespace {

using glm::dvec2, glm::dvec3;

constexpr double kStep_deg = 0.25;         // between vertices; a chord lies at most 15 m under the Earth's surface
constexpr std::size_t kPartVertices = 48;  // vertices of a part, which is drawn or left out as a whole
constexpr double kBeyond_px = 16.0;        // lines continue past the picture's edges
constexpr double kNearest_m = 0.1;         // in front of the eye

double distance_to_chord(const dvec3& p, const dvec3& a, const dvec3& b) {
  const dvec3 way = b - a;
  const double length2 = glm::dot(way, way);
  const double part = length2 > 0.0 ? std::clamp(glm::dot(p - a, way) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + part * way);
}

}  // namespace

MapLines::MapLines(const std::vector<MapLine>& lines, const Ellipsoid& ellipsoid)
    : ellipsoid_(ellipsoid), half_axes_m_(ellipsoid.a_m(), ellipsoid.a_m(), ellipsoid.b_m()) {
  for (const MapLine& line : lines) {
    if (line.places.size() >= 2) add(line);
  }
}

void MapLines::add(const MapLine& line) {
  const std::size_t first = vertices_.size();
  const auto put = [this](double lat_deg, double lon_deg) {
    const EcefDir normal = Ellipsoid::normal(Angle::degrees(lat_deg), Angle::degrees(lon_deg));
    vertices_.push_back({ellipsoid_.position(normal).xyz_m / half_axes_m_, 0.0F});
  };
  put(line.places.front().lat.deg(), line.places.front().lon.deg());
  for (std::size_t k = 1; k < line.places.size(); ++k) {
    const Geodetic &a = line.places[k - 1], &b = line.places[k];
    const double north = b.lat.deg() - a.lat.deg(), east = std::remainder(b.lon.deg() - a.lon.deg(), 360.0);
    const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(north, east) / kStep_deg)));
    for (int i = 1; i <= steps; ++i) put(a.lat.deg() + north * i / steps, a.lon.deg() + east * i / steps);
  }
  Line made{.kind = line.kind};
  add_parts(made, first);
  lines_.push_back(made);
}

void MapLines::add_parts(Line& line, std::size_t first) {
  constexpr float kAlways = std::numeric_limits<float>::infinity();
  const std::size_t last = vertices_.size() - 1;
  line.first_part = parts_.size();
  for (std::size_t from = first; from < last; from += kPartVertices) {
    const std::size_t to = std::min(from + kPartVertices, last);
    vertices_[from].importance_m = vertices_[to].importance_m = kAlways;
    weigh(from, to, kAlways);
    dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (std::size_t k = from; k <= to; ++k) {
      low = glm::min(low, vertices_[k].unit * half_axes_m_);
      high = glm::max(high, vertices_[k].unit * half_axes_m_);
    }
    parts_.push_back({from, to - from + 1, 0.5 * (low + high), 0.5 * glm::distance(low, high)});
  }
  line.parts = parts_.size() - line.first_part;
  const bool closed = glm::distance(vertices_[first].unit, vertices_[last].unit) < 1e-9;
  if (closed && line.parts == 1) line.closed_radius_m = parts_.back().radius_m;
}

// A place is at most as important as the place that divides its part of the line.
void MapLines::weigh(std::size_t first, std::size_t last, float most_m) {
  if (last - first < 2) return;
  const dvec3 a = vertices_[first].unit * half_axes_m_, b = vertices_[last].unit * half_axes_m_;
  std::size_t farthest = first + 1;
  double most = -1.0;
  for (std::size_t k = first + 1; k < last; ++k) {
    const double distance = distance_to_chord(vertices_[k].unit * half_axes_m_, a, b);
    if (distance > most) most = distance, farthest = k;
  }
  const float importance_m = std::min(static_cast<float>(most), most_m);
  vertices_[farthest].importance_m = importance_m;
  weigh(first, farthest, importance_m);
  weigh(farthest, last, importance_m);
}

/// The lines of one picture.
class MapTracer {
 public:
  MapTracer(const MapLines& map, const View& view, const Ground& ground, double error_px)
      : map_(map), view_(view), ground_(ground), eye_(view.eye.xyz_m / map.half_axes_m_), error_px_(error_px) {
    const double width = view.viewport.width_px, height = view.viewport.height_px;
    low_ = dvec2(-kBeyond_px), high_ = dvec2(width, height) + kBeyond_px;
    const std::array<dvec3, 4> corners{pixel_ray(view, low_).xyz, pixel_ray(view, {high_.x, low_.y}).xyz,
                                       pixel_ray(view, high_).xyz, pixel_ray(view, {low_.x, high_.y}).xyz};
    for (std::size_t k = 0; k < 4; ++k) sides_[k] = glm::normalize(glm::cross(corners[k], corners[(k + 1) % 4]));
  }

  std::vector<MapPiece> trace() {
    if (glm::dot(eye_, eye_) <= 1.0) return {};  // under the ground, where no place faces the eye
    for (const MapLines::Line& line : map_.lines_) {
      kind_ = line.kind;
      for (std::size_t k = line.first_part; k < line.first_part + line.parts; ++k) {
        if (in_sight(map_.parts_[k]) && !is_too_small(line, map_.parts_[k])) trace(map_.parts_[k]);
      }
    }
    return std::move(pieces_);
  }

 private:
  struct Spot {
    dvec3 seen_m;  ///< right, up and forward of the eye
    double rise;   ///< > 0: the place faces the eye
  };

  [[nodiscard]] double nearest_m(const MapLines::Part& part) const {
    return std::max(glm::distance(part.middle_m, view_.eye.xyz_m) - part.radius_m, kNearest_m);
  }

  [[nodiscard]] bool is_too_small(const MapLines::Line& line, const MapLines::Part& part) const {
    return line.closed_radius_m > 0.0 && line.closed_radius_m * view_.pixels_per_radian() < error_px_ * nearest_m(part);
  }

  /// False if the whole part is beside the picture or behind the horizon.
  [[nodiscard]] bool in_sight(const MapLines::Part& part) const {
    const dvec3 middle = part.middle_m / map_.half_axes_m_;
    const double radius = part.radius_m / map_.ellipsoid_.b_m();
    if (glm::dot(middle, eye_) + radius * glm::length(eye_) <= 1.0) return false;
    const double room_m = part.radius_m + (ground_.has_relief() ? kHighest_m : 0.0);
    const dvec3 offset = part.middle_m - view_.eye.xyz_m;
    return std::ranges::none_of(sides_, [&](const dvec3& inward) { return glm::dot(inward, offset) < -room_m; });
  }

  [[nodiscard]] Spot spot(const dvec3& unit) const {
    dvec3 p_m = unit * map_.half_axes_m_;
    if (ground_.has_relief()) {
      const EcefDir normal{glm::normalize(unit / map_.half_axes_m_)};
      const Geodetic place = Ellipsoid::lat_lon(normal);
      p_m += ground_.height_m(place.lat, place.lon) * normal.xyz;
    }
    const dvec3 offset = p_m - view_.eye.xyz_m;
    return {{glm::dot(offset, view_.right), glm::dot(offset, view_.up), glm::dot(offset, view_.forward)},
            glm::dot(unit, eye_) - 1.0};
  }

  void trace(const MapLines::Part& part) {
    const double exact_m = error_px_ * nearest_m(part) / view_.pixels_per_radian();
    const auto least_m = static_cast<float>(std::exp2(std::floor(std::log2(exact_m))));
    std::optional<Spot> last;
    for (std::size_t k = part.first; k < part.first + part.count; ++k) {
      if (map_.vertices_[k].importance_m < least_m) continue;
      const Spot now = spot(map_.vertices_[k].unit);
      if (last) add(*last, now);
      last = now;
    }
  }

  /// Cuts a chord at the horizon, in front of the eye, and at the picture's edges.
  void add(Spot a, Spot b) {
    const auto cut = [&a, &b](double at_a, double at_b) {
      if (at_a <= 0.0 && at_b <= 0.0) return false;
      const double part = at_a / (at_a - at_b);
      const Spot between{glm::mix(a.seen_m, b.seen_m, part), glm::mix(a.rise, b.rise, part)};
      if (at_a <= 0.0) a = between;
      if (at_b <= 0.0) b = between;
      return true;
    };
    if (!cut(a.rise, b.rise) || !cut(a.seen_m.z - kNearest_m, b.seen_m.z - kNearest_m)) return;
    dvec2 from = px(a), to = px(b);
    if (!clip(from, to)) return;
    if (pieces_.empty() || pieces_.back().kind != kind_ || pieces_.back().points_px.back() != from) {
      pieces_.push_back({kind_, {from}});
    }
    pieces_.back().points_px.push_back(to);
  }

  [[nodiscard]] dvec2 px(const Spot& at) const {
    const dvec2 slope = dvec2(at.seen_m) / at.seen_m.z;
    return 0.5 * dvec2(view_.viewport.width_px, view_.viewport.height_px) +
           dvec2(slope.x - view_.shear_x, -slope.y) * view_.pixels_per_radian();
  }

  /// Keeps the part of a chord within the picture (Liang and Barsky, 1984); false if there is none.
  [[nodiscard]] bool clip(dvec2& from, dvec2& to) const {
    const dvec2 way = to - from;
    double begin = 0.0, end = 1.0;
    for (int axis = 0; axis < 2; ++axis) {
      if (way[axis] == 0.0) {
        if (from[axis] < low_[axis] || from[axis] > high_[axis]) return false;
        continue;
      }
      const double at_low = (low_[axis] - from[axis]) / way[axis], at_high = (high_[axis] - from[axis]) / way[axis];
      begin = std::max(begin, std::min(at_low, at_high));
      end = std::min(end, std::max(at_low, at_high));
    }
    if (!(begin < end)) return false;
    const dvec2 start = from;
    if (begin > 0.0) from = start + begin * way;
    if (end < 1.0) to = start + end * way;
    return true;
  }

  static constexpr double kHighest_m = 2.0e5;  // ground with exaggeration, generously

  const MapLines& map_;
  const View& view_;
  const Ground& ground_;
  dvec3 eye_;  ///< in the space of the unit sphere
  double error_px_;
  dvec2 low_{0.0}, high_{0.0};
  std::array<dvec3, 4> sides_{};  ///< planes through the eye; inside is positive
  MapLineKind kind_ = MapLineKind::coast;
  std::vector<MapPiece> pieces_;
};

std::vector<MapPiece> MapLines::trace(const View& view, const Ground& ground, double error_px) const {
  return MapTracer(*this, view, ground, error_px).trace();
}

}  // namespace terrella
