#include "streaming/georeference/warp_extent.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace terrella {
namespace {

constexpr int kExtentProbes = 65;  ///< along each side
/// Smaller gaps between the longitudes of probes do not count: the picture then goes round the planet.
constexpr double kGap_deg = 15.0;
/// A picture that goes round the planet and reaches this latitude contains the pole.
constexpr double kNearPole_deg = 80.0;

bool on_planet(const CrsPoint& p) { return std::isfinite(p.x) && std::abs(p.y) <= 90.0 + 1e-9; }

/// Angle between two places, degrees.
double apart_deg(const CrsPoint& p, const CrsPoint& q) {
  const double to_rad = M_PI / 180.0;
  const double half_lat = std::sin(0.5 * (p.y - q.y) * to_rad), half_lon = std::sin(0.5 * (p.x - q.x) * to_rad);
  const double chord = half_lat * half_lat + std::cos(p.y * to_rad) * std::cos(q.y * to_rad) * half_lon * half_lon;
  return 2.0 * std::asin(std::min(1.0, std::sqrt(chord))) / to_rad;
}

/// West and east of the places, in a turn from -180° on; east may exceed 180.
std::pair<double, double> longitudes_of(const std::vector<CrsPoint>& places) {
  std::vector<double> lons;
  for (const CrsPoint& p : places) lons.push_back(p.x - 360.0 * std::floor((p.x + 180.0) / 360.0));
  std::ranges::sort(lons);
  double gap = lons.front() + 360.0 - lons.back();
  double west = lons.front(), east = lons.back();
  for (std::size_t i = 1; i < lons.size(); ++i) {
    if (lons[i] - lons[i - 1] <= gap) continue;
    gap = lons[i] - lons[i - 1];
    west = lons[i];
    east = lons[i - 1] + 360.0;
  }
  return gap < kGap_deg ? std::pair(-180.0, 180.0) : std::pair(west, east);
}

/// Smaller side of the pixel in the middle of the probes with a place; 0: unknown.
double pixel_of(const Affine& transform, const Crs& crs, CrsPoint middle) {
  const std::vector<CrsPoint> corners = {transform.at(middle.x, middle.y), transform.at(middle.x + 1.0, middle.y),
                                         transform.at(middle.x, middle.y + 1.0)};
  const auto places = crs.places(corners);
  if (!places || !std::ranges::all_of(*places, on_planet)) return 0.0;
  return std::min(apart_deg((*places)[0], (*places)[1]), apart_deg((*places)[0], (*places)[2]));
}

}  // namespace

std::optional<DegreeGrid> warp_extent(const PictureFile& picture, const Georeference& said, const Crs& crs) {
  if (!said.transform) return {};
  std::vector<CrsPoint> pixels, points;
  for (int k = 0; k < kExtentProbes * kExtentProbes; ++k) {
    pixels.push_back({static_cast<double>(picture.width_px) * (k % kExtentProbes) / (kExtentProbes - 1),
                      static_cast<double>(picture.height_px) * (k / kExtentProbes) / (kExtentProbes - 1)});
    points.push_back(said.transform->at(pixels.back().x, pixels.back().y));
  }
  const auto all = crs.places(points);
  if (!all) return {};
  std::vector<CrsPoint> places, of_pixels;
  for (std::size_t k = 0; k < all->size(); ++k) {
    if (!on_planet((*all)[k])) continue;
    places.push_back((*all)[k]);
    of_pixels.push_back(pixels[k]);
  }
  if (places.size() < 4) return {};
  const double pixel = pixel_of(*said.transform, crs, of_pixels[of_pixels.size() / 2]);
  if (!(pixel > 1e-9)) return {};
  const auto [west, east] = longitudes_of(places);
  const auto [south_at, north_at] = std::ranges::minmax(places, {}, &CrsPoint::y);
  double south = south_at.y - pixel, north = north_at.y + pixel;
  if (east - west >= 360.0 && north > kNearPole_deg) north = 90.0;
  if (east - west >= 360.0 && south < -kNearPole_deg) south = -90.0;
  const double aside = east - west >= 360.0 ? 0.0 : pixel;
  return grid_over(west - aside, std::max(-90.0, south), east + aside, std::min(90.0, north), pixel);
}

}  // namespace terrella
