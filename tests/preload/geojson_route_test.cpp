#include "streaming/preload/geojson_route.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/GeodesicLine.hpp>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "geo/body.h"
#include "tests/preload/plan_support.h"

namespace terrella {
namespace {

using test::set_of;

struct Stop {
  double lon, lat;
};
using Way = std::vector<Stop>;

std::string line_text(const Way& way) {
  std::string text;
  for (const Stop& stop : way) text += fmt::format("{}[{},{},9]", text.empty() ? "" : ",", stop.lon, stop.lat);
  return R"({"type":"LineString","coordinates":[)" + text + "]}";
}

glm::dvec3 ecef(const Stop& place) {
  return earth().ellipsoid.to_ecef({.lat = Angle::degrees(place.lat), .lon = Angle::degrees(place.lon)}).xyz_m;
}

struct Dense {
  Stop place;
  glm::dvec3 at;
};

/// Places on the geodesics of a way, by GeographicLib.
std::vector<Dense> dense(const Way& way, double step_m) {
  const auto& geodesics = GeographicLib::Geodesic::WGS84();
  std::vector<Dense> places;
  for (std::size_t k = 1; k < way.size(); ++k) {
    const auto line = geodesics.InverseLine(way[k - 1].lat, way[k - 1].lon, way[k].lat, way[k].lon);
    const int count = static_cast<int>(std::ceil(line.Distance() / step_m)) + 1;
    for (int n = 0; n <= count; ++n) {
      Stop at{};
      line.Position(line.Distance() * n / count, at.lat, at.lon);
      places.push_back({at, ecef(at)});
    }
  }
  return places;
}

/// Corners of a tile; in Web Mercator by its own formula.
MapRect rect_of(const TileGrid& grid, const TileId& id) {
  const double span = grid.root_span_deg / double(std::int64_t{1} << id.level);
  const auto lat = [&](std::int64_t row) {
    if (grid.projection != Projection::web_mercator) return 90.0 - double(row) * span;
    const double y = std::numbers::pi * (1.0 - 2.0 * double(row) / double(std::int64_t{1} << id.level));
    return std::atan(std::sinh(y)) * 180.0 / std::numbers::pi;
  };
  return {.west_deg = -180.0 + double(id.x) * span,
          .south_deg = lat(id.y + 1),
          .east_deg = -180.0 + double(id.x + 1) * span,
          .north_deg = lat(id.y)};
}

/// Least distance of places from a tile by its middle and its diagonal, metres; less than the truth.
double least_m(const MapRect& rect, const std::vector<Dense>& way) {
  const Stop middle{std::midpoint(rect.west_deg, rect.east_deg), std::midpoint(rect.south_deg, rect.north_deg)};
  const glm::dvec3 at = ecef(middle);
  double farthest = 0.0, nearest = std::numeric_limits<double>::max();
  for (const Stop& corner : {Stop{rect.west_deg, rect.south_deg}, Stop{rect.west_deg, rect.north_deg}})
    farthest = std::max(farthest, glm::distance(at, ecef(corner)));
  for (const Dense& one : way) nearest = std::min(nearest, glm::distance(at, one.at));
  return nearest - 1.1 * farthest;
}

/// Distance of a tile from places, metres, at most some metres beside the truth.
double distance_m(const MapRect& rect, const std::vector<Dense>& way) {
  constexpr int kSide = 32;
  double nearest = std::numeric_limits<double>::max();
  Stop of_tile{}, of_way{};
  for (const Dense& one : way) {
    const double lon = std::remainder(one.place.lon - rect.west_deg, 360.0);
    const double east = lon < 0.0 ? lon + 360.0 : lon;
    if (east <= rect.east_deg - rect.west_deg && one.place.lat >= rect.south_deg && one.place.lat <= rect.north_deg)
      return 0.0;
  }
  for (int n = 0; n <= kSide; ++n) {
    const double lon = std::lerp(rect.west_deg, rect.east_deg, double(n) / kSide);
    const double lat = std::lerp(rect.south_deg, rect.north_deg, double(n) / kSide);
    for (const Stop& place :
         {Stop{lon, rect.south_deg}, Stop{lon, rect.north_deg}, Stop{rect.west_deg, lat}, Stop{rect.east_deg, lat}}) {
      const glm::dvec3 at = ecef(place);
      for (const Dense& one : way) {
        const double chord = glm::distance(at, one.at);
        if (chord >= nearest) continue;
        nearest = chord;
        of_tile = place;
        of_way = one.place;
      }
    }
  }
  double metres = 0.0;
  GeographicLib::Geodesic::WGS84().Inverse(of_tile.lat, of_tile.lon, of_way.lat, of_way.lon, metres);
  return metres;
}

struct Trip {
  const char* name;
  Way way;
  double radius_m;
  int level;
};

void expect_exact(const TileGrid& grid, const Trip& trip) {
  const auto region = parse_geojson_route(line_text(trip.way), "r.geojson", trip.radius_m, earth().ellipsoid);
  ASSERT_TRUE(region) << region.error().message;
  const auto tiles = set_of(*plan_region(grid, earth().ellipsoid, *region, trip.level, trip.level));
  const std::vector<Dense> way = dense(trip.way, trip.radius_m / 40.0);
  const double beside_m = 0.01 * trip.radius_m + 50.0;  // errors of the region and of the samples
  std::int64_t inside = 0;
  const std::int64_t side = std::int64_t{1} << trip.level;
  const std::int64_t columns = grid.root_span_deg == 180.0 ? 2 * side : side;
  for (std::int64_t x = 0; x < columns; ++x) {
    for (std::int64_t y = 0; y < side; ++y) {
      const TileId id{trip.level, x, y};
      const MapRect rect = rect_of(grid, id);
      const double least = least_m(rect, way);
      const double metres = least > 1.1 * trip.radius_m ? least : distance_m(rect, way);
      const bool planned = tiles.contains(id);
      if (metres < trip.radius_m - 1.0) {
        ASSERT_TRUE(planned) << trip.name << " lacks " << x << "," << y << " at " << metres;
      }
      if (metres > trip.radius_m + beside_m) {
        ASSERT_FALSE(planned) << trip.name << " has " << x << "," << y << " at " << metres;
      }
      inside += planned ? 1 : 0;
    }
  }
  EXPECT_EQ(inside, static_cast<std::int64_t>(tiles.size()));
  EXPECT_GT(inside, 0);
}

const std::vector<Trip> kTrips = {
    {"Alps", {{5.0, 44.0}, {9.0, 46.5}, {16.0, 47.5}}, 60'000.0, 6},
    {"antimeridian", {{170.0, -15.0}, {-165.0, -20.0}}, 150'000.0, 6},
    {"longitudes that go on", {{170.0, 40.0}, {195.0, 45.0}}, 150'000.0, 6},
    {"over the north pole", {{10.0, 80.0}, {-170.0, 84.0}}, 200'000.0, 6},
    {"round the south pole", {{0.0, -88.0}, {120.0, -88.5}, {-120.0, -88.0}}, 100'000.0, 6},
    {"oceans", {{-74.0, 40.7}, {103.8, 1.3}}, 400'000.0, 5},
    {"one place", {{30.0, 0.0}, {30.0, 0.0}}, 300'000.0, 6},
};

TEST(GeojsonRoute, HasTheTilesWithinTheRadiusAndNoOther) {
  TileGrid grid;
  grid.max_level = 8;
  for (const Trip& trip : kTrips) expect_exact(grid, trip);
}

TEST(GeojsonRoute, HasThemInWebMercator) {
  TileGrid grid;
  grid.projection = Projection::web_mercator;
  grid.root_span_deg = 360.0;
  grid.max_level = 8;
  expect_exact(grid, kTrips[0]);
  expect_exact(grid, kTrips[1]);
}

TEST(GeojsonRoute, DenseLinesAreThoseOfTheirEnds) {
  const std::vector<Dense> places = dense({{5.0, 44.0}, {16.0, 47.5}}, 20.0);
  Way dense_way;
  dense_way.reserve(places.size());
  for (const Dense& one : places) dense_way.push_back(one.place);
  ASSERT_GT(dense_way.size(), 40'000U);
  TileGrid grid;
  grid.max_level = 9;
  const auto tiles = [&](const Way& way, double radius_m) {
    const auto region = parse_geojson_route(line_text(way), "r.geojson", radius_m, earth().ellipsoid);
    EXPECT_TRUE(region) << region.error().message;
    return set_of(*plan_region(grid, earth().ellipsoid, *region, 9, 9));
  };
  const auto all = tiles(dense_way, 10'000.0), ends = tiles({{5.0, 44.0}, {16.0, 47.5}}, 10'000.0);
  std::vector<TileId> other;
  std::ranges::set_symmetric_difference(all, ends, std::back_inserter(other));
  EXPECT_LT(other.size(), ends.size() / 100 + 2);
}

TEST(GeojsonRoute, SaysWhatIsWrong) {
  const auto why = [](const std::string& text, double radius_m) {
    const auto region = parse_geojson_route(text, "r.geojson", radius_m, earth().ellipsoid);
    return region ? std::string() : region.error().message;
  };
  EXPECT_EQ(why(line_text({{5.0, 44.0}}), 1e3), "r.geojson: a line has fewer than 2 positions");
  EXPECT_EQ(why(R"({"type":"FeatureCollection","features":[]})", 1e3), "r.geojson: there is no line in it");
  const std::string polygon = R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[]}})";
  EXPECT_EQ(why(R"({"type":"FeatureCollection","features":[)" + polygon + "]}", 1e3),
            "r.geojson: feature 1: its geometry is a Polygon; a LineString or MultiLineString is needed");
  EXPECT_NE(why(line_text(kTrips[0].way), 2e6).find("is more than the 1275627 m"), std::string::npos);
  EXPECT_NE(why(line_text({{5.0, 91.0}, {6.0, 7.0}}), 1e3).find("not on the planet"), std::string::npos);
  EXPECT_NE(why(R"({"type":"MultiLineString"})", 1e3).find("no list \"coordinates\""), std::string::npos);
}

}  // namespace
}  // namespace terrella
