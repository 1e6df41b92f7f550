#include "streaming/preload/region.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace terrella {
namespace {

constexpr std::size_t kBands = 2048;

std::size_t band_of(double lat_deg) {
  const double part = (lat_deg + 90.0) / 180.0 * static_cast<double>(kBands);
  return static_cast<std::size_t>(std::clamp(part, 0.0, static_cast<double>(kBands - 1)));
}

/// True if a straight segment passes through the inside of a rectangle. Liang and Barsky 1984,
/// doi:10.1145/357332.357333: narrows the parameter range of the segment side by side.
bool passes_through(const MapPoint& a, const MapPoint& b, const MapRect& rect) {
  double enters = 0.0;
  double leaves = 1.0;
  const auto narrow = [&](double from, double step, double low, double high) {
    if (step == 0.0) return from > low && from < high;
    const double at_low = (low - from) / step;
    const double at_high = (high - from) / step;
    enters = std::max(enters, std::min(at_low, at_high));
    leaves = std::min(leaves, std::max(at_low, at_high));
    return enters <= leaves;
  };
  if (!narrow(a.lon_deg, b.lon_deg - a.lon_deg, rect.west_deg, rect.east_deg)) return false;
  if (!narrow(a.lat_deg, b.lat_deg - a.lat_deg, rect.south_deg, rect.north_deg)) return false;
  return enters < leaves;
}

}  // namespace

Region::Region() : bands_(kBands) {}

void Region::add_box(const GeoRect& box) {
  const MapRect rect{box.west.deg(), box.south.deg(), box.east.deg(), box.north.deg()};
  if (rect.west_deg <= rect.east_deg) {
    boxes_.push_back(rect);
    return;
  }
  boxes_.push_back({rect.west_deg, rect.south_deg, 180.0, rect.north_deg});
  boxes_.push_back({-180.0, rect.south_deg, rect.east_deg, rect.north_deg});
}

void Region::add_segment(const MapPoint& a, const MapPoint& b) {
  const auto number = static_cast<std::uint32_t>(segments_.size());
  segments_.push_back({a, b, polygons_});
  const auto [south, north] = std::minmax(a.lat_deg, b.lat_deg);
  for (std::size_t band = band_of(south); band <= band_of(north); ++band) bands_[band].push_back(number);
}

void Region::add_polygon(const std::vector<MapRing>& rings) {
  for (const MapRing& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) add_segment(ring[i], ring[(i + 1) % ring.size()]);
  }
  ++polygons_;
}

void Region::add(const Region& other) {
  boxes_.insert(boxes_.end(), other.boxes_.begin(), other.boxes_.end());
  const std::uint32_t first = polygons_;
  for (const Segment& segment : other.segments_) {
    polygons_ = first + segment.polygon;
    add_segment(segment.a, segment.b);
  }
  polygons_ = first + other.polygons_;
}

Region::Segments Region::all_segments() const {
  Segments all(segments_.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

Overlap Region::classify(const MapRect& rect, std::span<const std::uint32_t> candidates, Segments& touched) const {
  touched.clear();
  bool cut = false;
  for (const MapRect& box : boxes_) {
    if (rect.west_deg >= box.west_deg && rect.east_deg <= box.east_deg && rect.south_deg >= box.south_deg &&
        rect.north_deg <= box.north_deg) {
      return Overlap::inside;
    }
    cut = cut || (rect.west_deg < box.east_deg && rect.east_deg > box.west_deg && rect.south_deg < box.north_deg &&
                  rect.north_deg > box.south_deg);
  }
  for (const std::uint32_t number : candidates) {
    const Segment& segment = segments_[number];
    if (passes_through(segment.a, segment.b, rect)) touched.push_back(number);
  }
  if (!touched.empty()) return Overlap::cut;
  const MapPoint centre{0.5 * (rect.west_deg + rect.east_deg), 0.5 * (rect.south_deg + rect.north_deg)};
  if (in_a_polygon(centre)) return Overlap::inside;
  return cut ? Overlap::cut : Overlap::outside;
}

// Even-odd rule along the parallel to the west. The segments of a band are in the order of their polygons.
bool Region::in_a_polygon(const MapPoint& p) const {
  bool odd = false;
  std::uint32_t polygon = 0;
  for (const std::uint32_t number : bands_[band_of(p.lat_deg)]) {
    const Segment& s = segments_[number];
    if (s.polygon != polygon) {
      if (odd) return true;
      polygon = s.polygon;
    }
    if ((s.a.lat_deg > p.lat_deg) == (s.b.lat_deg > p.lat_deg)) continue;
    const double part = (p.lat_deg - s.a.lat_deg) / (s.b.lat_deg - s.a.lat_deg);
    if (s.a.lon_deg + part * (s.b.lon_deg - s.a.lon_deg) < p.lon_deg) odd = !odd;
  }
  return odd;
}

}  // namespace terrella
