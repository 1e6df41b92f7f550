#include "objects/graticule.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "objects/degree_name.h"
#include "objects/graticule_tracer.h"
#include "view/surface_pin.h"

namespace terrella {
namespace {

constexpr double kSpacings_deg[] = {90.0, 30.0, 15.0, 10.0, 5.0,  2.0,   1.0,   0.5,
                                    0.2,  0.1,  0.05, 0.02, 0.01, 0.005, 0.002, 0.001};
constexpr double kWidest_deg = 30.0;       // widest spacing at the picture's centre
constexpr double kLeastSpacing_px = 90.0;  // between lines at the picture's centre
// Lines of the centre's spacing, and wider ones, fade between these distances of their neighbours.
constexpr double kFaint_px = 10.0, kFull_px = 24.0;
// Lines in front of the centre that are finer than there appear between these distances of their neighbours.
constexpr double kFineFaint_px = 90.0, kFineFull_px = 130.0;
constexpr double kMostSteps = 400.0;  // chords of half a line
constexpr long kMostLines = 90;       // lines of a level
constexpr int kLooks = 12;            // looks along a side of the picture that find the ground in it
// On a whole globe, only meridians this near to the picture's centre are labelled.
constexpr double kNamedMeridians_deg = 50.0;
constexpr float kNamedStrength = 0.5F;  // fainter lines have no label

double spacing_for(double pixels_per_degree) {
  double best = kWidest_deg;
  for (const double spacing : kSpacings_deg) {
    if (spacing <= kWidest_deg && spacing * pixels_per_degree >= kLeastSpacing_px) best = spacing;
  }
  return best;
}

bool divides(double fine, double wide) { return std::abs(std::remainder(wide, fine)) < 1e-6 * fine; }

/// Spacings of which each is a multiple of the next, with `centre` among them; the widest first. So a line of a wide
/// spacing is a line of each finer spacing too.
std::vector<double> levels_with(double centre) {
  std::vector<double> levels{centre};
  for (auto wide = std::rbegin(kSpacings_deg); wide != std::rend(kSpacings_deg); ++wide) {
    if (*wide > levels.front() && divides(levels.front(), *wide)) levels.insert(levels.begin(), *wide);
  }
  for (const double fine : kSpacings_deg) {
    if (fine < levels.back() && divides(fine, levels.back())) levels.push_back(fine);
  }
  return levels;
}

/// Length of chords between two crossings. Wide spacings occur with whole globes and at poles, where lines are most
/// curved.
double chord_deg(double spacing_deg) { return spacing_deg / (spacing_deg >= 5.0 ? 24.0 : 8.0); }

class Builder {
 public:
  Builder(const View& view, const Ellipsoid& ellipsoid, LabelSize label)
      : view_(view), tracer_(view, ellipsoid), label_(label) {
    const Geodetic eye = ellipsoid.to_geodetic(view.eye);
    const Grab middle = grab(view, ellipsoid, {0.5 * view.viewport.width_px, 0.5 * view.viewport.height_px});
    const double distance_m = middle.on_surface ? glm::distance(middle.point.xyz_m, view.eye.xyz_m) : eye.height_m;
    const double pixels = tracer_.pixels_per_degree(distance_m);
    centre_ = ellipsoid.to_geodetic(middle.point);
    under_lat_deg_ = eye.lat.deg();
    under_lon_deg_ = eye.lon.deg();
    find_ground_in_view(ellipsoid);
    out_.parallels_deg = spacing_for(pixels);
    out_.meridians_deg = spacing_for(pixels * std::max(std::cos(centre_.lat.rad()), 1e-9));
  }

  Graticule build() {
    double wider = 0.0;
    for (const double spacing : levels_with(out_.parallels_deg)) {
      if (!add_parallels(traced(spacing, out_.parallels_deg, false), wider)) break;
      wider = spacing;
    }
    wider = 0.0;
    for (const double spacing : levels_with(out_.meridians_deg)) {
      if (!add_meridians(traced(spacing, out_.meridians_deg, true), wider)) break;
      wider = spacing;
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] static TracedSpacing traced(double spacing_deg, double centre_deg, bool narrows) {
    const bool finer = spacing_deg < centre_deg;
    return {spacing_deg, narrows, finer ? kFineFaint_px : kFaint_px, finer ? kFineFull_px : kFull_px};
  }
  [[nodiscard]] double reach_deg(const TracedSpacing& spacing) const {
    return tracer_.reach_deg(spacing.faint_px / spacing.spacing_deg);
  }
  [[nodiscard]] double south(double reach) const { return std::max({under_lat_deg_ - reach, south_deg_, -90.0}); }
  [[nodiscard]] double north(double reach) const { return std::min({under_lat_deg_ + reach, north_deg_, 90.0}); }

  /// Finds bounds of the ground in the picture and somewhat around it.
  void find_ground_in_view(const Ellipsoid& ellipsoid) {
    south_deg_ = 90.0, north_deg_ = -90.0, west_deg_ = HUGE_VAL, east_deg_ = -HUGE_VAL;
    const glm::dvec2 size(view_.viewport.width_px, view_.viewport.height_px);
    for (int j = 0; j <= kLooks; ++j) {
      for (int i = 0; i <= kLooks; ++i) {
        const Geodetic place = ellipsoid.to_geodetic(
            grab(view_, ellipsoid, (1.5 * glm::dvec2(i, j) / double(kLooks) - 0.25) * size).point);
        const double lon = under_lon_deg_ + std::remainder(place.lon.deg() - under_lon_deg_, 360.0);
        south_deg_ = std::min(south_deg_, place.lat.deg()), north_deg_ = std::max(north_deg_, place.lat.deg());
        west_deg_ = std::min(west_deg_, lon), east_deg_ = std::max(east_deg_, lon);
      }
    }
    const double lat_margin = (north_deg_ - south_deg_) / kLooks, lon_margin = (east_deg_ - west_deg_) / kLooks;
    south_deg_ -= lat_margin, north_deg_ += lat_margin, west_deg_ -= lon_margin, east_deg_ += lon_margin;
    for (const double pole : {-90.0, 90.0}) {
      const Ecef at = ellipsoid.to_ecef({.lat = Angle::degrees(pole), .lon = {}});
      if ((view_.eye.xyz_m.z - at.xyz_m.z) * pole <= 0.0) continue;  // behind the horizon
      const auto px = project(view_, at);
      if (!px || glm::any(glm::greaterThan(glm::abs(*px - 0.5 * size), 0.75 * size))) continue;
      (pole < 0.0 ? south_deg_ : north_deg_) = pole;
      west_deg_ = under_lon_deg_ - 180.0, east_deg_ = under_lon_deg_ + 180.0;
    }
  }

  /// West and east end of the longitudes within `reach` of the place under the eye, as far as the picture shows them.
  [[nodiscard]] std::pair<double, double> longitudes(double reach) const {
    double lons = 180.0;
    if (std::max(std::abs(under_lat_deg_ - reach), std::abs(under_lat_deg_ + reach)) < 90.0) {
      const double sine = std::sin(Angle::degrees(reach).rad()) / std::cos(Angle::degrees(under_lat_deg_).rad());
      if (sine < 1.0) lons = Angle::radians(std::asin(sine)).deg();
    }
    return {std::max(under_lon_deg_ - lons, west_deg_), std::min(under_lon_deg_ + lons, east_deg_)};
  }

  /// Numbers of the lines of a spacing from `low` to `high`, without those of `wider`.
  [[nodiscard]] static std::vector<long> numbers(double low, double high, double spacing, double wider) {
    std::vector<long> out;
    const long first = std::lround(std::ceil(low / spacing - 1e-9));
    long last = std::min(std::lround(std::floor(high / spacing + 1e-9)), first + kMostLines);
    // 180° east and 180° west of the middle are one meridian.
    if (double(last - first + 1) * spacing > 360.0 + 1e-9) --last;
    for (long i = first; i <= last; ++i) {
      if (wider == 0.0 || !divides(wider, double(i) * spacing)) out.push_back(i);
    }
    return out;
  }

  /// False if the ground has no room for lines of this spacing.
  bool add_parallels(const TracedSpacing& spacing, double wider) {
    const double reach = reach_deg(spacing);
    if (reach <= 0.0) return false;
    const auto [west, east] = longitudes(reach);
    for (const long i : numbers(south(reach), north(reach), spacing.spacing_deg, wider)) {
      const double lat = double(i) * spacing.spacing_deg;
      if (std::abs(lat) > 90.0 - 1e-9) continue;
      const double step = chord_deg(std::min(spacing.spacing_deg, out_.meridians_deg));
      const auto pieces =
          tracer_.trace([&](double lon) { return Geodetic{.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)}; },
                        spacing, west, east, std::max(step, (east - west) / kMostSteps));
      add_lines(pieces, i == 0);
      label_parallel(pieces, degree_name(lat, std::min(spacing.spacing_deg, out_.parallels_deg), "N", "S"));
    }
    return true;
  }

  bool add_meridians(const TracedSpacing& spacing, double wider) {
    const double reach = reach_deg(spacing);
    if (reach <= 0.0) return false;
    const auto [west, east] = longitudes(reach);
    if (south(reach) >= north(reach)) return true;
    for (const long i : numbers(west, east, spacing.spacing_deg, wider)) {
      const double lon = std::remainder(double(i) * spacing.spacing_deg, 360.0);
      const double step = chord_deg(std::min(spacing.spacing_deg, out_.parallels_deg));
      const auto pieces = tracer_.trace(
          [&](double lat) { return Geodetic{.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)}; }, spacing,
          south(reach), north(reach), std::max(step, (north(reach) - south(reach)) / kMostSteps));
      add_lines(pieces, std::abs(lon) < 1e-9 || std::abs(std::abs(lon) - 180.0) < 1e-9);
      // Near the limb the labels would stand too close to be read.
      const bool faces_eye = std::abs(std::remainder(lon - centre_.lon.deg(), 360.0)) < kNamedMeridians_deg;
      if (faces_eye)
        label_meridian(pieces, spacing, lon,
                       degree_name(lon, std::min(spacing.spacing_deg, out_.meridians_deg), "E", "W"));
    }
    return true;
  }

  void add_lines(const std::vector<TracedPiece>& pieces, bool principal) {
    for (const TracedPiece& piece : pieces) out_.lines.push_back({piece.points_px, principal, piece.strength});
  }

  [[nodiscard]] bool inside(glm::dvec2 px) const {
    return px.x >= 0.0 && px.y >= 0.0 && px.x <= view_.viewport.width_px &&
           px.y <= view_.viewport.height_px - label_.foot_px;
  }

  /// Finds the crossing of a line with x = value (axis 0) or y = value (axis 1).
  [[nodiscard]] std::optional<glm::dvec2> crossing(const std::vector<TracedPiece>& pieces, int axis,
                                                   double value) const {
    for (const auto& [piece, strength] : pieces) {
      if (strength < kNamedStrength) continue;
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

  void label_parallel(const std::vector<TracedPiece>& pieces, const std::string& text) {
    if (const auto edge = crossing(pieces, 0, 0.0)) {
      put({text, *edge + glm::dvec2(0.5 * label_.character_px, -2.0), {0.0, 1.0}});
      return;
    }
    std::optional<glm::dvec2> leftmost;
    for (const auto& [piece, strength] : pieces) {
      for (const glm::dvec2 px : piece) {
        if (strength >= kNamedStrength && inside(px) && (!leftmost || px.x < leftmost->x)) leftmost = px;
      }
    }
    if (leftmost) put({text, *leftmost - glm::dvec2(0.6 * label_.character_px, 0.0), {1.0, 0.5}});
  }

  void label_meridian(const std::vector<TracedPiece>& pieces, const TracedSpacing& spacing, double lon_deg,
                      const std::string& text) {
    if (const auto edge = crossing(pieces, 1, view_.viewport.height_px - label_.foot_px)) {
      put({text, *edge + glm::dvec2(0.4 * label_.character_px, -0.4 * label_.line_px), {0.0, 1.0}});
      return;
    }
    const double lat_deg =
        std::clamp(out_.parallels_deg * std::round(centre_.lat.deg() / out_.parallels_deg), -60.0, 60.0);
    const auto step =
        tracer_.trace([&](double lat) { return Geodetic{.lat = Angle::degrees(lat), .lon = Angle::degrees(lon_deg)}; },
                      spacing, lat_deg, lat_deg + 0.01 * out_.parallels_deg, out_.parallels_deg);
    if (step.empty() || step.front().strength < kNamedStrength) return;
    const glm::dvec2 at = step.front().points_px.front();
    if (inside(at)) put({text, at + glm::dvec2(0.4 * label_.character_px, -2.0), {0.0, 1.0}});
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
  GraticuleTracer tracer_;
  Geodetic centre_;                                                             ///< place at the picture's centre
  double south_deg_ = 0.0, north_deg_ = 0.0, west_deg_ = 0.0, east_deg_ = 0.0;  ///< bounds of the ground in the picture
  double under_lat_deg_ = 0.0, under_lon_deg_ = 0.0;                            ///< place under the eye
  LabelSize label_;
  Graticule out_;
  std::vector<Box> taken_;
};

}  // namespace

Graticule make_graticule(const View& view, const Ellipsoid& ellipsoid, LabelSize label) {
  return Builder(view, ellipsoid, label).build();
}

}  // namespace terrella
