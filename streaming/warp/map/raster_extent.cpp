#include "streaming/warp/map/raster_extent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace terrella {
namespace {

constexpr int kAlong = 256;  ///< steps along an edge
constexpr int kInside = 32;  ///< steps through the raster, each way
constexpr int kParallels = 181;

bool is_placed(const RowPlace& place) { return std::isfinite(place.lon_deg) && std::isfinite(place.row_deg); }

double in_turn(double lon_deg) { return lon_deg - 360.0 * std::floor((lon_deg + 180.0) / 360.0); }

std::vector<CrsPoint> probes(double width_px, double height_px) {
  std::vector<CrsPoint> pixels;
  for (int i = 0; i <= kAlong; ++i) {
    const double x = width_px * i / kAlong, y = height_px * i / kAlong;
    for (const CrsPoint& at : {CrsPoint{x, 0.0}, {x, height_px}, {0.0, y}, {width_px, y}}) pixels.push_back(at);
  }
  for (int k = 0; k < kInside * kInside; ++k) {
    pixels.push_back({width_px * (k % kInside + 0.5) / kInside, height_px * (k / kInside + 0.5) / kInside});
  }
  return pixels;
}

class Finder {
 public:
  Finder(const GroundMap& map, double width_px, double height_px)
      : map_(map), width_px_(width_px), height_px_(height_px) {}

  [[nodiscard]] bool holds_any(const std::vector<RowPlace>& places) const {
    std::vector<CrsPoint> pixels(places.size());
    map_.pixels(places, pixels);
    return std::ranges::any_of(pixels, [this](const CrsPoint& pixel) { return holds(pixel); });
  }

  /// True if a place on a meridian lies on the raster.
  [[nodiscard]] bool meets_meridian(double lon_deg, double south_deg, double north_deg) const {
    std::vector<RowPlace> places;
    for (int i = 0; i < kParallels; ++i) {
      places.push_back({lon_deg, std::lerp(south_deg, north_deg, (i + 0.5) / kParallels)});
    }
    return holds_any(places);
  }

 private:
  [[nodiscard]] bool holds(CrsPoint pixel) const {
    if (const auto& turn = map_.turn_px(); turn && std::abs(turn->x) > 0.0) {
      const double back = std::ceil(pixel.x / turn->x - 1.0);
      for (double k = back; k >= back - 2.0; --k) {
        if (is_on({pixel.x - k * turn->x, pixel.y - k * turn->y})) return true;
      }
    }
    return is_on(pixel);
  }
  [[nodiscard]] bool is_on(const CrsPoint& pixel) const {
    return pixel.x >= 0.0 && pixel.x <= width_px_ && pixel.y >= 0.0 && pixel.y <= height_px_;
  }

  const GroundMap& map_;
  const double width_px_, height_px_;
};

/// Sets the longitudes: the largest gap between probes is outside, if it is not merely between two probes.
void set_longitudes(const Finder& raster, std::vector<double> lons, RasterExtent& extent) {
  std::ranges::sort(lons);
  double gap = lons.front() + 360.0 - lons.back();
  extent.west_deg = lons.front();
  extent.east_deg = lons.back();
  for (std::size_t i = 1; i < lons.size(); ++i) {
    if (lons[i] - lons[i - 1] <= gap) continue;
    gap = lons[i] - lons[i - 1];
    extent.west_deg = lons[i];
    extent.east_deg = lons[i - 1] + 360.0;
  }
  const double middle = extent.east_deg + 0.5 * gap;
  if (gap > 1e-9 && !raster.meets_meridian(middle, extent.south_deg, extent.north_deg)) return;
  extent.west_deg = -180.0;
  extent.east_deg = 180.0;
}

/// Half the distance over which pixels per degree are measured: a pixel. Some projections have noise over less: PROJ's
/// Van der Grinten is wrong by a kilometre near its centre.
double step_deg(const GroundMap& map, const CrsPoint& pixel, const RowPlace& place) {
  constexpr double kLeast = 1e-4, kMost = 0.5;
  double step = kLeast;
  const std::array neighbours = {CrsPoint{pixel.x + 1.0, pixel.y}, CrsPoint{pixel.x, pixel.y + 1.0}};
  for (const RowPlace& beside : map.places(neighbours)) {
    if (is_placed(beside)) step = std::max(step, std::abs(beside.row_deg - place.row_deg));
  }
  return std::min(step, kMost);
}

}  // namespace

std::optional<RasterExtent> raster_extent(const GroundMap& map, double width_px, double height_px) {
  std::vector<RowPlace> places = map.places(probes(width_px, height_px));
  std::erase_if(places, [](const RowPlace& place) { return !is_placed(place); });
  if (places.empty()) return {};
  const Finder raster(map, width_px, height_px);
  const auto [south, north] = std::ranges::minmax(places, {}, &RowPlace::row_deg);
  RasterExtent extent{.south_deg = south.row_deg, .north_deg = north.row_deg};
  std::vector<double> lons;
  for (const RowPlace& place : places) lons.push_back(in_turn(place.lon_deg));
  bool at_pole = false;
  for (const double pole : {-90.0, 90.0}) {
    if (!raster.holds_any({{0.0, pole}, {90.0, pole}, {180.0, pole}, {-90.0, pole}})) continue;
    (pole < 0.0 ? extent.south_deg : extent.north_deg) = pole;
    at_pole = at_pole || !map.turn_px();
  }
  if (!at_pole) set_longitudes(raster, std::move(lons), extent);
  return extent;
}

std::optional<double> pixels_per_degree(const GroundMap& map, double width_px, double height_px) {
  // The middle, or the place nearest to it.
  std::vector<CrsPoint> pixels = probes(width_px, height_px);
  pixels.push_back({0.5 * width_px, 0.5 * height_px});
  const auto off = [&](const CrsPoint& p) { return std::hypot(p.x / width_px - 0.5, p.y / height_px - 0.5); };
  std::ranges::sort(pixels, {}, off);
  const std::vector<RowPlace> places = map.places(pixels);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const RowPlace& place = places[i];
    if (!is_placed(place)) continue;
    const double step = step_deg(map, pixels[i], place);
    // At a pole the meridian's direction counts alone: longitudes meet.
    const double row = std::clamp(place.row_deg, -89.9 + step, 89.9 - step);
    const std::array around = {RowPlace{place.lon_deg - step, row}, RowPlace{place.lon_deg + step, row},
                               RowPlace{place.lon_deg, row - step}, RowPlace{place.lon_deg, row + step}};
    std::array<CrsPoint, 4> at{};
    map.pixels(around, at);
    const double by_lon = std::hypot(at[1].x - at[0].x, at[1].y - at[0].y) / (2.0 * step);
    const double by_row = std::hypot(at[3].x - at[2].x, at[3].y - at[2].y) / (2.0 * step);
    const double most = std::max(by_lon, by_row);
    if (std::isfinite(most) && most > 0.0) return most;
  }
  return {};
}

}  // namespace terrella
