#include "streaming/preload/geojson_route.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "geo/great_circle.h"
#include "geo/measure.h"
#include "streaming/preload/geojson_region.h"
#include "streaming/preload/geojson_text.h"

namespace terrella {
namespace {

// Parts of the equatorial radius, below those of ring_around_way().
constexpr double kLongestPiece = 0.25;
constexpr double kLargestRadius = 0.2;
/// Positions nearer than this part of the radius to the last one add nothing to the region; it is wider by as much.
constexpr double kNearPart = 4.0e-3;

/// Adds the places near some lines to a region, one polygon for each piece of a leg.
class RouteReader {
 public:
  RouteReader(double radius_m, const Ellipsoid& ellipsoid)
      : radius_m_(radius_m),
        around_m_((1.0 + kNearPart) * radius_m + Angle::degrees(kArcTolerance_deg).rad() * ellipsoid.a_m()),
        ellipsoid_(ellipsoid) {}

  Status add_geometry(const nlohmann::json& geometry) {
    const std::string type = geojson_type(geometry);
    const auto add = [this](const nlohmann::json& line) { return add_line(line); };
    if (type == "MultiLineString") return for_each_entry(geometry, "coordinates", add);
    if (type == "LineString") return add_line(geometry.value("coordinates", nlohmann::json()));
    return Error{fmt::format("its geometry is {}; a LineString or MultiLineString is needed",
                             type.empty() ? "none" : "a " + type.substr(0, 40))};
  }
  [[nodiscard]] Region take() { return std::move(region_); }
  [[nodiscard]] bool found() const { return !region_.empty(); }

 private:
  Status add_line(const nlohmann::json& positions) {
    if (!positions.is_array() || positions.size() < 2) return Error{"a line has fewer than 2 positions"};
    std::optional<Geodetic> from;
    bool alone = true;  // no leg was added yet
    for (const nlohmann::json& entry : positions) {
      const auto position = geojson_position(entry);
      if (!position) return position.error();
      const Geodetic to{.lat = Angle::degrees(position->lat_deg), .lon = Angle::degrees(position->lon_deg)};
      const double way_m = from ? geodesic_m(ellipsoid_, *from, to) : 0.0;
      if (from && way_m < kNearPart * radius_m_) continue;
      if (from) {
        if (Status added = add_leg(*from, to, way_m); !added) return added;
        alone = false;
      }
      from = to;
    }
    return alone ? add_piece(*from, *from) : Status(Done{});
  }

  Status add_leg(const Geodetic& from, const Geodetic& to, double way_m) {
    const int pieces = static_cast<int>(std::ceil(way_m / (kLongestPiece * ellipsoid_.a_m())));
    const std::vector<Geodetic> ends = geodesic_places(ellipsoid_, from, to, pieces + 1);
    for (std::size_t k = 1; k < ends.size(); ++k) {
      if (Status added = add_piece(ends[k - 1], ends[k]); !added) return added;
    }
    return Done{};
  }

  Status add_piece(const Geodetic& from, const Geodetic& to) {
    const std::vector<Geodetic> ring = ring_around_way(ellipsoid_, from, to, around_m_);
    std::vector<MapPoint> places;
    places.reserve(ring.size());
    for (const Geodetic& place : ring) places.push_back({place.lon.deg(), place.lat.deg()});
    const auto rings = rings_of(places);
    if (!rings) return rings.error();
    for (const MapRing& part : *rings) points_ += part.size();
    if (points_ > kMaxRegionPoints) {
      return Error{
          fmt::format("more than {} points round it; simplify the route, or take it in parts", kMaxRegionPoints)};
    }
    region_.add_polygon(*rings);
    return Done{};
  }

  const double radius_m_;
  const double around_m_;  ///< with room for omitted positions, and for the pieces that replace arcs (great_circle.h)
  const Ellipsoid ellipsoid_;
  Region region_;
  std::size_t points_ = 0;
};

}  // namespace

Result<Region> parse_geojson_route(std::string_view text, const std::string& where, double radius_m,
                                   const Ellipsoid& ellipsoid) {
  const auto object = parse_geojson(text, where);
  if (!object) return object.error();
  if (radius_m > kLargestRadius * ellipsoid.a_m()) {
    return Error{
        fmt::format("{}: a radius of {} m is more than the {:.0f} m that a route can have on this body; a box "
                    "or a polygon covers more",
                    where, radius_m, kLargestRadius * ellipsoid.a_m())};
  }
  RouteReader reader(radius_m, ellipsoid);
  const auto take = [&](const nlohmann::json& geometry) { return reader.add_geometry(geometry); };
  if (const Status read = for_each_geometry(*object, take); !read) {
    return Error{fmt::format("{}: {}", where, read.error().message)};
  }
  if (!reader.found()) return Error{fmt::format("{}: there is no line in it", where)};
  return reader.take();
}

Result<Region> read_geojson_route(const std::filesystem::path& path, double radius_m, const Ellipsoid& ellipsoid) {
  const auto text = read_geojson_text(path);
  if (!text) return text.error();
  return parse_geojson_route(*text, path.string(), radius_m, ellipsoid);
}

}  // namespace terrella
