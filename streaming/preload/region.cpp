#include "streaming/preload/region.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace terrella {
namespace {

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

/// True if a place lies to the left of an edge, whose ends are in order. A place on the edge counts as a little to the
/// north, and much less to the east, as it does in crosses(). So ways that meet at a place agree.
bool is_left(const MapPoint& a, const MapPoint& b, const MapPoint& p) {
  const double north = (b.lon_deg - a.lon_deg) * (p.lat_deg - a.lat_deg);
  const double east = (b.lat_deg - a.lat_deg) * (p.lon_deg - a.lon_deg);
  return north > east || (north == east && b.lon_deg > a.lon_deg);
}

/// True if an edge crosses a piece of a parallel or meridian, on which `axis` is constant.
bool crosses(const MapPoint& a, const MapPoint& b, const MapPoint& from, const MapPoint& to, double MapPoint::*axis) {
  if ((a.*axis > from.*axis) == (b.*axis > from.*axis)) return false;
  return is_left(a, b, from) != is_left(a, b, to);
}

}  // namespace

void Region::add_box(const GeoRect& box) {
  const MapRect rect{box.west.deg(), box.south.deg(), box.east.deg(), box.north.deg()};
  if (rect.west_deg <= rect.east_deg) {
    boxes_.push_back(rect);
    return;
  }
  boxes_.push_back({rect.west_deg, rect.south_deg, 180.0, rect.north_deg});
  boxes_.push_back({-180.0, rect.south_deg, rect.east_deg, rect.north_deg});
}

// Equal edges of one polygon cancel each other in pairs.
void Region::add_polygon(const std::vector<MapRing>& rings) {
  const auto order = [](const MapPoint& p) { return std::pair(p.lon_deg, p.lat_deg); };
  const auto ends = [&order](const Segment& s) { return std::pair(order(s.a), order(s.b)); };
  std::vector<Segment> edges;
  for (const MapRing& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto [a, b] = std::minmax(ring[i], ring[(i + 1) % ring.size()],
                                      [&order](const MapPoint& p, const MapPoint& q) { return order(p) < order(q); });
      edges.push_back({a, b, polygons_});
    }
  }
  std::ranges::sort(edges, {}, ends);
  const std::size_t first = segments_.size();
  for (const Segment& edge : edges) {
    if (segments_.size() > first && ends(segments_.back()) == ends(edge)) {
      segments_.pop_back();
    } else {
      segments_.push_back(edge);
    }
  }
  ++polygons_;
}

void Region::add(const Region& other) {
  boxes_.insert(boxes_.end(), other.boxes_.begin(), other.boxes_.end());
  for (const Segment& segment : other.segments_) {
    segments_.push_back({segment.a, segment.b, polygons_ + segment.polygon});
  }
  polygons_ += other.polygons_;
}

double Region::edge_steps(double tile_span_deg) const {
  double steps = 0.0;
  for (const auto& [a, b, polygon] : segments_) {
    steps += 1.0 + (std::abs(b.lon_deg - a.lon_deg) + std::abs(b.lat_deg - a.lat_deg)) / tile_span_deg;
  }
  return steps;
}

Region::Sight Region::whole() const {
  constexpr double kBeyond_deg = 10.0;  // beside all polygons
  Sight all{{-180.0 - kBeyond_deg, -90.0 - kBeyond_deg}, std::vector<std::uint32_t>(segments_.size()), {}};
  std::iota(all.segments.begin(), all.segments.end(), 0U);
  return all;
}

Overlap Region::classify(const MapRect& rect, const Sight& outer, Sight& seen) const {
  seen.segments.clear();
  bool cut = false;
  for (const MapRect& box : boxes_) {
    if (rect.west_deg >= box.west_deg && rect.east_deg <= box.east_deg && rect.south_deg >= box.south_deg &&
        rect.north_deg <= box.north_deg) {
      return Overlap::inside;
    }
    cut = cut || (rect.west_deg < box.east_deg && rect.east_deg > box.west_deg && rect.south_deg < box.north_deg &&
                  rect.north_deg > box.south_deg);
  }
  for (const std::uint32_t number : outer.segments) {
    const Segment& segment = segments_[number];
    if (passes_through(segment.a, segment.b, rect)) seen.segments.push_back(number);
  }
  seen.middle = {0.5 * (rect.west_deg + rect.east_deg), 0.5 * (rect.south_deg + rect.north_deg)};
  seen.around = around(seen.middle, outer);
  // A polygon around the middle without an edge in the rectangle contains the rectangle.
  auto touching = seen.segments.begin();
  for (const std::uint32_t polygon : seen.around) {
    touching = std::find_if(touching, seen.segments.end(),
                            [&](std::uint32_t number) { return segments_[number].polygon >= polygon; });
    if (touching == seen.segments.end() || segments_[*touching].polygon != polygon) return Overlap::inside;
  }
  return cut || !seen.segments.empty() ? Overlap::cut : Overlap::outside;
}

// Goes from the middle of the outer rectangle along a parallel, then along a meridian. Each edge that this way crosses
// inverts whether its polygon contains the place (even-odd rule). All of these edges touch the outer rectangle.
std::vector<std::uint32_t> Region::around(const MapPoint& place, const Sight& outer) const {
  const MapPoint corner{place.lon_deg, outer.middle.lat_deg};
  std::vector<std::uint32_t> crossed;  // polygons with an odd number of crossings
  for (const std::uint32_t number : outer.segments) {
    const Segment& s = segments_[number];
    const bool first = crosses(s.a, s.b, outer.middle, corner, &MapPoint::lat_deg);
    const bool second = crosses(s.a, s.b, corner, place, &MapPoint::lon_deg);
    if (first == second) continue;
    if (!crossed.empty() && crossed.back() == s.polygon) {
      crossed.pop_back();
    } else {
      crossed.push_back(s.polygon);
    }
  }
  std::vector<std::uint32_t> now;
  std::ranges::set_symmetric_difference(outer.around, crossed, std::back_inserter(now));
  return now;
}

}  // namespace terrella
