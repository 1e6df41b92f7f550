#include "streaming/objects/feature_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/number.h"
#include "geo/great_circle.h"
#include "streaming/preload/geojson_text.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr double kMostHeight_m = 1.0e9;
constexpr double kMetresOfKm = 1000.0;
constexpr int kMostCollections = 4;  // RFC 7946 advises against nested collections
constexpr double kMostPieces = 2.0e6;

/// Twice the way from a marker's place to its right end.
float width_px(const PointObject& point) {
  const PointIcon& icon = point.icon;
  if (!icon.image || icon.from_north || icon.heading.rad() != 0.0) return point.size_px;
  const int longest = std::max(icon.image->width_px, icon.image->height_px);
  return 2.0F * (1.0F - icon.anchor.x) * point.size_px * float(icon.image->width_px) / float(longest);
}

class GeometryReader {
 public:
  GeometryReader(const ObjectStyle& style, ThirdCoordinate third, ObjectScene& scene, const Complain& complain)
      : style_(style), third_(third), scene_(scene), complain_(complain) {}

  void add(const json& geometry, int collections) {
    const std::string type = geojson_type(geometry);
    if (type == "GeometryCollection" && collections > 0) {
      for_parts(geometry, "geometries", [&](const json& part) -> Status { return add(part, collections - 1), Done{}; });
    } else if (type == "Point") {
      whole(geometry, [this](const json& c) { return add_point(c); });
    } else if (type == "MultiPoint") {
      for_parts(geometry, "coordinates", [this](const json& c) { return add_point(c); });
    } else if (type == "LineString") {
      whole(geometry, [this](const json& c) { return add_line(c); });
    } else if (type == "MultiLineString") {
      for_parts(geometry, "coordinates", [this](const json& c) { return add_line(c); });
    } else if (type == "Polygon") {
      whole(geometry, [this](const json& c) { return add_polygon(c); });
    } else if (type == "MultiPolygon") {
      for_parts(geometry, "coordinates", [this](const json& c) { return add_polygon(c); });
    } else {
      complain_(type.empty() ? "its geometry has no \"type\""
                             : fmt::format("{} is not a geometry of RFC 7946", in_quotes(type)));
    }
  }

 private:
  template <class Read>
  void whole(const json& geometry, const Read& read) {
    has_heights_ = false;
    const auto coordinates = geometry.find("coordinates");
    const Status done =
        coordinates == geometry.end() ? Error{"its geometry has no \"coordinates\""} : read(*coordinates);
    if (!done) complain_(done.error().message);
  }

  template <class Read>
  void for_parts(const json& geometry, const char* member, const Read& read) {
    const auto parts = geometry.find(member);
    if (parts == geometry.end() || !parts->is_array()) {
      return complain_(fmt::format("its geometry has no list \"{}\"", member));
    }
    for (std::size_t k = 0; k < parts->size(); ++k) {
      has_heights_ = false;
      if (const Status done = read((*parts)[k]); !done) {
        complain_(fmt::format("part {}: {}", k + 1, done.error().message));
      }
    }
  }

  Result<Geodetic> read_place(const json& position) {
    const auto flat = geojson_position(position);
    if (!flat) return flat.error();
    Geodetic place{.lat = Angle::degrees(flat->lat_deg), .lon = Angle::degrees(flat->lon_deg)};
    if (position.size() < 3) return place;
    has_heights_ = true;
    if (!position[2].is_number()) return Error{"the third coordinate of a position is not a number"};
    const double third = position[2].get<double>();
    place.height_m = third_ == ThirdCoordinate::depth_km ? -kMetresOfKm * third : third;
    if (!(std::abs(place.height_m) <= kMostHeight_m)) {
      return Error{fmt::format("the height {} is out of range; it is in metres over the ellipsoid", third)};
    }
    return place;
  }

  Result<std::vector<Geodetic>> read_places(const json& positions, std::size_t fewest, const char* what) {
    if (!positions.is_array() || positions.size() < fewest) {
      return Error{fmt::format("{} has fewer than {} positions", what, fewest)};
    }
    std::vector<Geodetic> places;
    places.reserve(positions.size());
    for (const json& position : positions) {
      const auto place = read_place(position);
      if (!place) return place.error();
      places.push_back(*place);
    }
    return places;
  }

  /// The meaning of the heights of the object that was read: the objects of a map have none and lie on the ground.
  [[nodiscard]] HeightMode heights() const {
    return style_.heights.value_or(has_heights_ ? HeightMode::absolute : HeightMode::clamp_to_ground);
  }

  Status add_point(const json& coordinates) {
    const auto place = read_place(coordinates);
    if (!place) return place.error();
    PointObject point = style_.point;
    point.place = *place;
    point.heights = heights();
    if (style_.mesh.model) {
      MeshObject mesh = style_.mesh;
      mesh.place = *place;
      mesh.heights = point.heights;
      scene_.meshes.push_back(std::move(mesh));
    } else {
      scene_.points.push_back(point);
    }
    if (style_.label.text.empty()) return Done{};
    LabelObject label = style_.label;
    label.place = *place;
    label.heights = point.heights;
    label.size_px = point.radius_m > 0.0 ? 0.0F : width_px(point);
    label.radius_m = point.radius_m;
    label.through_surface = point.through_surface;
    scene_.labels.push_back(std::move(label));
    return Done{};
  }

  Status add_line(const json& coordinates) {
    auto places = read_places(coordinates, 2, "a line");
    if (!places) return places.error();
    LineObject line = style_.line;
    line.places = std::move(*places);
    line.heights = heights();
    scene_.lines.push_back(std::move(line));
    return Done{};
  }

  Status add_polygon(const json& coordinates) {
    if (!coordinates.is_array() || coordinates.empty()) return Error{"a polygon without rings"};
    PolygonObject polygon = style_.polygon;
    double pieces = 0.0;
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      auto ring = read_ring(coordinates[k], pieces);
      if (!ring) return Error{fmt::format("ring {}: {}", k + 1, ring.error().message)};
      polygon.rings.push_back(std::move(*ring));
    }
    polygon.heights = heights();
    scene_.polygons.push_back(std::move(polygon));
    return Done{};
  }

  Result<std::vector<Geodetic>> read_ring(const json& positions, double& pieces) {
    constexpr std::size_t kFewest = 4;  // RFC 7946, 3.1.6: the last repeats the first
    auto places = read_places(positions, kFewest, "it");
    if (!places) return places.error();
    const json &first = positions.front(), &last = positions.back();
    if (first[0] != last[0] || first[1] != last[1]) {
      return Error{fmt::format("it is not closed: it begins at {},{} and ends at {},{}; repeat the first position",
                               first[0].get<double>(), first[1].get<double>(), last[0].get<double>(),
                               last[1].get<double>())};
    }
    std::vector<MapPoint> ring;
    for (const json& position : positions) ring.push_back(*geojson_position(position));
    pieces += pieces_of(ring);
    if (pieces > kMostPieces) return Error{"it is too long: it goes round the planet hundreds of times"};
    if (const auto parts = rings_of(ring); !parts) return parts.error();
    places->pop_back();
    return places;
  }

  const ObjectStyle& style_;
  ThirdCoordinate third_;
  ObjectScene& scene_;
  const Complain& complain_;
  bool has_heights_ = false;  ///< the object that is read has positions with a third coordinate
};

}  // namespace

void add_geometry(const json& geometry, const ObjectStyle& style, ThirdCoordinate third, ObjectScene& scene,
                  const Complain& complain) {
  GeometryReader(style, third, scene, complain).add(geometry, kMostCollections);
}

}  // namespace terrella
