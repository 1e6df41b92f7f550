#include "streaming/preload/geojson_region.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "geo/great_circle.h"
#include "streaming/preload/geojson_text.h"

namespace terrella {
namespace {

using nlohmann::json;

/// The estimate of pieces_of() is on the high side, for edges along meridians by far.
constexpr double kMostPiecesPerPoint = 4.0;

class RegionReader {
 public:
  Status add_geometry(const json& geometry) {
    const std::string type = geojson_type(geometry);
    if (type == "MultiPolygon") {
      return for_each_entry(geometry, "coordinates", [this](const json& part) { return add_polygon(part); });
    }
    if (type != "Polygon") {
      return Error{fmt::format("its geometry is {}; a Polygon or MultiPolygon is needed",
                               type.empty() ? "none" : "a " + type.substr(0, 40))};
    }
    const auto rings = geometry.find("coordinates");
    return rings == geometry.end() ? Status(Error{"a Polygon without \"coordinates\""}) : add_polygon(*rings);
  }
  [[nodiscard]] Region take() { return std::move(region_); }
  [[nodiscard]] bool found() const { return !region_.empty(); }

 private:
  Status add_polygon(const json& coordinates) {
    if (!coordinates.is_array() || coordinates.empty()) return Error{"a polygon without rings"};
    std::vector<MapRing> rings;
    for (const json& ring : coordinates) {
      const auto positions = read_ring(ring);
      if (!positions) return positions.error();
      // An edge may need many points, so their number is estimated before they are made.
      if (pieces_of(*positions) > kMostPiecesPerPoint * double(kMaxRegionPoints)) return too_many_points();
      auto parts = rings_of(*positions);
      if (!parts) return parts.error();
      for (MapRing& part : *parts) {
        points_ += part.size();
        rings.push_back(std::move(part));
      }
      if (points_ > kMaxRegionPoints) return too_many_points();
    }
    region_.add_polygon(rings);
    return Done{};
  }

  static Error too_many_points() {
    return Error{
        fmt::format("more than {} points, with those that divide long edges; simplify the polygons", kMaxRegionPoints)};
  }

  static Result<std::vector<MapPoint>> read_ring(const json& ring) {
    constexpr std::size_t kFewest = 4;  // RFC 7946, 3.1.6: the last repeats the first
    if (!ring.is_array() || ring.size() < kFewest) return Error{"a ring has fewer than 4 positions"};
    std::vector<MapPoint> positions;
    for (const json& entry : ring) {
      const auto position = geojson_position(entry);
      if (!position) return position.error();
      positions.push_back(*position);
    }
    const MapPoint& first = positions.front();
    const MapPoint& last = positions.back();
    if (first.lon_deg != last.lon_deg || first.lat_deg != last.lat_deg) {
      return Error{fmt::format("a ring is not closed: it begins at {},{} and ends at {},{}", first.lon_deg,
                               first.lat_deg, last.lon_deg, last.lat_deg)};
    }
    positions.pop_back();
    return positions;
  }

  Region region_;
  std::size_t points_ = 0;
};

}  // namespace

Result<Region> parse_geojson_region(std::string_view text, const std::string& where) {
  const auto object = parse_geojson(text, where);
  if (!object) return object.error();
  RegionReader reader;
  const Status read = for_each_geometry(*object, [&](const json& geometry) { return reader.add_geometry(geometry); });
  if (!read) {
    return Error{fmt::format("{}: {}", where, read.error().message)};
  }
  if (!reader.found())
    return Error{fmt::format("{}: there is no polygon in it, or its rings cancel each other", where)};
  return reader.take();
}

Result<Region> read_geojson_region(const std::filesystem::path& path) {
  const auto text = read_geojson_text(path);
  if (!text) return text.error();
  return parse_geojson_region(*text, path.string());
}

}  // namespace terrella
