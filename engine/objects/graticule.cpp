#include "objects/graticule.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>

#include "objects/degree_name.h"
#include "view/surface_pin.h"

namespace terrella {
namespace {

constexpr double kSpacings_deg[] = {30.0, 15.0, 10.0, 5.0,  2.0,   1.0,   0.5,  0.2,
                                    0.1,  0.05, 0.02, 0.01, 0.005, 0.002, 0.001};
constexpr double kLeastSpacing_px = 90.0;
constexpr int kLinesEachWay = 28;  // lines to each side of the picture's centre; more would run together
constexpr int kHalvings = 20;      // bisections of a chord that the horizon cuts
// On a whole globe, only meridians this near to the picture's centre are labelled.
constexpr double kNamedMeridians_deg = 50.0;
constexpr double kBeyond = 0.25;  // lines continue past the picture's edges by this fraction of its size

double spacing_for(double pixels_per_degree) {
  double best = kSpacings_deg[0];
  for (const double spacing : kSpacings_deg) {
    if (spacing * pixels_per_degree >= kLeastSpacing_px) best = spacing;
  }
  return best;
}

/// Length of chords between two crossings. Wide spacings occur with whole globes and at poles, where lines are most
/// curved.
double chord_deg(double spacing_deg) { return spacing_deg / (spacing_deg >= 5.0 ? 24.0 : 8.0); }

/// The part of the planet near the picture's centre, and the spacing of lines in it.
struct Region {
  double lat_deg, lon_deg;
  double parallels_deg, meridians_deg;
  double reach_deg;  ///< visible great-circle distance from the centre
};

Region region_of(const View& view, const Ellipsoid& ellipsoid) {
  const Geodetic eye = ellipsoid.to_geodetic(view.eye);
  const Grab centre = grab(view, ellipsoid, {0.5 * view.viewport.width_px, 0.5 * view.viewport.height_px});
  const Geodetic place = ellipsoid.to_geodetic(centre.point);
  const double distance_m = centre.on_surface ? glm::distance(centre.point.xyz_m, view.eye.xyz_m) : eye.height_m;
  const double pixels_per_degree =
      view.pixels_per_radian() / std::max(distance_m, 0.1) * ellipsoid.a_m() * Angle::degrees(1.0).rad();
  const double horizon_deg =
      Angle::radians(std::acos(ellipsoid.b_m() / (ellipsoid.b_m() + std::max(eye.height_m, 1.0)))).deg();
  Region region{place.lat.deg(), place.lon.deg(), spacing_for(pixels_per_degree), 0.0, 2.0 * horizon_deg};
  const double narrowing = std::max(std::cos(place.lat.rad()), 1e-9);
  region.meridians_deg = spacing_for(pixels_per_degree * narrowing);
  region.reach_deg = std::min(region.reach_deg, kLinesEachWay * region.parallels_deg);
  return region;
}

/// Traces one curve on the ellipsoid into the visible pieces of its picture.
class Tracer {
 public:
  Tracer(const View& view, const Ellipsoid& ellipsoid) : view_(view), ellipsoid_(ellipsoid) {}

  using Curve = std::function<Geodetic(double)>;

  [[nodiscard]] std::vector<std::vector<glm::dvec2>> trace(const Curve& curve, double from, double to,
                                                           double step) const {
    std::vector<std::vector<glm::dvec2>> pieces;
    const int count = std::max(1, static_cast<int>(std::ceil((to - from) / step)));
    std::optional<glm::dvec2> last;
    for (int i = 0; i <= count; ++i) {
      const double at = from + (to - from) * i / count;
      const auto px = picture(curve(at));
      const double before = from + (to - from) * (i - 1) / count;
      if (px && !last) {
        pieces.emplace_back();
        if (i > 0) pieces.back().push_back(edge(curve, at, before));
      }
      if (px) pieces.back().push_back(*px);
      if (!px && last) pieces.back().push_back(edge(curve, before, at));
      last = px;
    }
    std::erase_if(pieces, [](const auto& piece) { return piece.size() < 2; });
    return pieces;
  }

 private:
  /// Returns the position of a place in the picture; nothing behind the horizon or far outside.
  [[nodiscard]] std::optional<glm::dvec2> picture(const Geodetic& place) const {
    const EcefDir normal = Ellipsoid::normal(place.lat, place.lon);
    const Ecef p = ellipsoid_.position(normal);
    if (glm::dot(view_.eye.xyz_m - p.xyz_m, normal.xyz) <= 0.0) return {};
    const auto px = project(view_, p);
    if (!px) return {};
    const glm::dvec2 size(view_.viewport.width_px, view_.viewport.height_px);
    const glm::dvec2 part = *px / size;
    const bool near = part.x > -kBeyond && part.x < 1.0 + kBeyond && part.y > -kBeyond && part.y < 1.0 + kBeyond;
    return near ? px : std::nullopt;
  }

  /// Finds the last visible point between a visible and a hidden one.
  [[nodiscard]] glm::dvec2 edge(const Curve& curve, double seen, double unseen) const {
    glm::dvec2 best = *picture(curve(seen));
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (seen + unseen);
      const auto px = picture(curve(middle));
      (px ? seen : unseen) = middle;
      if (px) best = *px;
    }
    return best;
  }

  const View& view_;
  const Ellipsoid& ellipsoid_;
};

class Builder {
 public:
  Builder(const View& view, const Ellipsoid& ellipsoid, LabelSize label)
      : view_(view), tracer_(view, ellipsoid), region_(region_of(view, ellipsoid)), label_(label) {}

  Graticule build() {
    out_.parallels_deg = region_.parallels_deg;
    out_.meridians_deg = region_.meridians_deg;
    add_parallels();
    add_meridians();
    return std::move(out_);
  }

 private:
  [[nodiscard]] double south() const { return std::max(region_.lat_deg - region_.reach_deg, -90.0); }
  [[nodiscard]] double north() const { return std::min(region_.lat_deg + region_.reach_deg, 90.0); }

  /// Visible longitudes to each side of the centre; all if a pole is visible.
  [[nodiscard]] double reach_lon_deg() const {
    const double farthest = std::max(std::abs(south()), std::abs(north()));
    if (farthest >= 90.0 || region_.reach_deg >= 90.0) return 180.0;
    const double sine =
        std::sin(Angle::degrees(region_.reach_deg).rad()) / std::cos(Angle::degrees(region_.lat_deg).rad());
    return sine >= 1.0 ? 180.0 : Angle::radians(std::asin(sine)).deg();
  }

  void add_parallels() {
    const double spacing = region_.parallels_deg;
    const double reach = std::min(reach_lon_deg(), kLinesEachWay * region_.meridians_deg);
    const long last = std::lround(std::floor(north() / spacing + 1e-9));
    for (long i = std::lround(std::ceil(south() / spacing - 1e-9)); i <= last; ++i) {
      const double lat = double(i) * spacing;
      if (std::abs(lat) > 90.0 - 1e-9) continue;
      const auto pieces =
          tracer_.trace([&](double lon) { return Geodetic{.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)}; },
                        region_.lon_deg - reach, region_.lon_deg + reach, chord_deg(region_.meridians_deg));
      add_lines(pieces, i == 0);
      label_parallel(pieces, degree_name(lat, spacing, "N", "S"));
    }
  }

  void add_meridians() {
    const double spacing = region_.meridians_deg;
    const double reach = std::min(reach_lon_deg(), kLinesEachWay * spacing);
    // Meridians meet at the pole: only every quarter continues to the pole.
    const double stop = 90.0 - std::min(region_.parallels_deg, 10.0);
    long first = std::lround(std::ceil((region_.lon_deg - reach) / spacing - 1e-9));
    const long last = std::lround(std::floor((region_.lon_deg + reach) / spacing + 1e-9));
    // 180° east and 180° west of the centre are one meridian.
    if (double(last - first + 1) * spacing > 360.0 + 1e-9) ++first;
    for (long i = first; i <= last; ++i) {
      const double lon = std::remainder(double(i) * spacing, 360.0);
      const bool quarter = std::abs(std::remainder(lon, 90.0)) < 1e-9;
      const double low = quarter ? south() : std::max(south(), -stop);
      const double high = quarter ? north() : std::min(north(), stop);
      if (low >= high) continue;
      const auto pieces =
          tracer_.trace([&](double lat) { return Geodetic{.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)}; },
                        low, high, chord_deg(region_.parallels_deg));
      add_lines(pieces, std::abs(lon) < 1e-9 || std::abs(std::abs(lon) - 180.0) < 1e-9);
      // Near the limb the labels would stand too close to be read.
      const bool faces_eye = std::abs(std::remainder(lon - region_.lon_deg, 360.0)) < kNamedMeridians_deg;
      if (faces_eye) label_meridian(pieces, lon, degree_name(lon, spacing, "E", "W"));
    }
  }

  void add_lines(const std::vector<std::vector<glm::dvec2>>& pieces, bool principal) {
    for (const auto& piece : pieces) out_.lines.push_back({piece, principal});
  }

  [[nodiscard]] bool inside(glm::dvec2 px) const {
    return px.x >= 0.0 && px.y >= 0.0 && px.x <= view_.viewport.width_px &&
           px.y <= view_.viewport.height_px - label_.foot_px;
  }

  /// Finds the crossing of a line with x = value (axis 0) or y = value (axis 1).
  [[nodiscard]] std::optional<glm::dvec2> crossing(const std::vector<std::vector<glm::dvec2>>& pieces, int axis,
                                                   double value) const {
    for (const auto& piece : pieces) {
      for (std::size_t i = 1; i < piece.size(); ++i) {
        const double a = piece[i - 1][axis] - value;
        const double b = piece[i][axis] - value;
        if ((a < 0.0) == (b < 0.0)) continue;
        const glm::dvec2 px = piece[i - 1] + (piece[i] - piece[i - 1]) * (a / (a - b));
        const double other = px[1 - axis];
        const double most = axis == 0 ? view_.viewport.height_px : view_.viewport.width_px;
        if (other > 0.0 && other < most) return px;
      }
    }
    return {};
  }

  void label_parallel(const std::vector<std::vector<glm::dvec2>>& pieces, const std::string& text) {
    if (const auto edge = crossing(pieces, 0, 0.0)) {
      put({text, *edge + glm::dvec2(0.5 * label_.character_px, -2.0), {0.0, 1.0}});
      return;
    }
    std::optional<glm::dvec2> leftmost;
    for (const auto& piece : pieces) {
      for (const glm::dvec2 px : piece) {
        if (inside(px) && (!leftmost || px.x < leftmost->x)) leftmost = px;
      }
    }
    if (leftmost) put({text, *leftmost - glm::dvec2(0.6 * label_.character_px, 0.0), {1.0, 0.5}});
  }

  void label_meridian(const std::vector<std::vector<glm::dvec2>>& pieces, double lon_deg, const std::string& text) {
    if (const auto edge = crossing(pieces, 1, view_.viewport.height_px - label_.foot_px)) {
      put({text, *edge + glm::dvec2(0.4 * label_.character_px, -0.4 * label_.line_px), {0.0, 1.0}});
      return;
    }
    const double lat_deg =
        std::clamp(region_.parallels_deg * std::round(region_.lat_deg / region_.parallels_deg), -60.0, 60.0);
    const auto step =
        tracer_.trace([&](double lat) { return Geodetic{.lat = Angle::degrees(lat), .lon = Angle::degrees(lon_deg)}; },
                      lat_deg, lat_deg + 0.01 * region_.parallels_deg, region_.parallels_deg);
    if (!step.empty() && inside(step.front().front())) {
      put({text, step.front().front() + glm::dvec2(0.4 * label_.character_px, -2.0), {0.0, 1.0}});
    }
  }

  /// Keeps a label if it lies in the picture and covers no earlier label.
  void put(const GraticuleLabel& label) {
    // The degree sign is two bytes but one character.
    const glm::dvec2 size(label_.character_px * double(label.text.size() - 1), label_.line_px);
    const glm::dvec2 low = label.at_px - label.anchor * size;
    if (!inside(low) || !inside(low + size)) return;
    for (const Box& box : taken_) {
      if (low.x < box.high.x && low.y < box.high.y && low.x + size.x > box.low.x && low.y + size.y > box.low.y) return;
    }
    taken_.push_back({low, low + size});
    out_.labels.push_back(label);
  }

  struct Box {
    glm::dvec2 low, high;
  };

  const View& view_;
  Tracer tracer_;
  Region region_;
  LabelSize label_;
  Graticule out_;
  std::vector<Box> taken_;
};

}  // namespace

Graticule make_graticule(const View& view, const Ellipsoid& ellipsoid, LabelSize label) {
  return Builder(view, ellipsoid, label).build();
}

}  // namespace terrella
