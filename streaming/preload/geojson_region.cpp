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
  Status add_document(const json& object) {
    const std::string type = geojson_type(object);
    if (type == "FeatureCollection") return add_features(object);
    if (type == "Feature") return add_feature(object);
    return add_geometry(object, true);
  }
  [[nodiscard]] Region take() { return std::move(region_); }
  [[nodiscard]] bool found() const { return !region_.empty(); }

 private:
  Status add_features(const json& object) {
    const auto features = object.find("features");
    if (features == object.end() || !features->is_array()) return Error{"a FeatureCollection without \"features\""};
    for (std::size_t i = 0; i < features->size(); ++i) {
      const json& feature = (*features)[i];
      if (const Status added = add_feature(feature); !added) {
        return Error{fmt::format("{}: {}", feature_name(feature, i), added.error().message)};
      }
    }
    return Done{};
  }

  Status add_feature(const json& feature) {
    if (geojson_type(feature) != "Feature") return Error{"not a Feature"};
    const auto geometry = feature.find("geometry");
    if (geometry == feature.end()) return Error{"a Feature without \"geometry\""};
    return geometry->is_null() ? Status(Done{}) : add_geometry(*geometry, true);
  }

  Status add_geometry(const json& geometry, bool collections) {
    const std::string type = geojson_type(geometry);
    if (type == "GeometryCollection" && collections) {
      return for_each(geometry, "geometries", [this](const json& part) { return add_geometry(part, false); });
    }
    if (type == "MultiPolygon") {
      return for_each(geometry, "coordinates", [this](const json& part) { return add_polygon(part); });
    }
    if (type != "Polygon") {
      return Error{fmt::format("its geometry is {}; a Polygon or MultiPolygon is needed",
                               type.empty() ? "none" : "a " + type.substr(0, 40))};
    }
    const auto rings = geometry.find("coordinates");
    return rings == geometry.end() ? Status(Error{"a Polygon without \"coordinates\""}) : add_polygon(*rings);
  }

  template <class Call>
  static Status for_each(const json& object, const char* member, const Call& call) {
    const auto parts = object.find(member);
    if (parts == object.end() || !parts->is_array()) return Error{fmt::format("it has no list \"{}\"", member)};
    for (const json& part : *parts) {
      if (const Status done = call(part); !done) return done.error();
    }
    return Done{};
  }

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
  if (const Status read = reader.add_document(*object); !read) {
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
