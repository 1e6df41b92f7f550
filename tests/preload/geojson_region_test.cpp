#include "streaming/preload/geojson_region.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <numbers>
#include <random>

#include "geo/body.h"
#include "geo/great_circle.h"
#include "tests/preload/plan_support.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

using test::box;
using test::set_of;

using Positions = std::vector<MapPoint>;

std::string ring_text(const Positions& ring) {
  std::string text;
  for (const MapPoint& p : ring) text += fmt::format("[{},{}],", p.lon_deg, p.lat_deg);
  return "[" + text + fmt::format("[{},{}]", ring.front().lon_deg, ring.front().lat_deg) + "]";
}
std::string polygon_text(const std::vector<Positions>& rings) {
  std::string text;
  for (const Positions& ring : rings) text += (text.empty() ? "" : ",") + ring_text(ring);
  return R"({"type":"Polygon","coordinates":[)" + text + "]}";
}

TileGrid grid_of(int max_level) {
  TileGrid grid;
  grid.max_level = max_level;
  return grid;
}

std::set<TileId> tiles_in(const std::string& geojson, int level) {
  auto region = parse_geojson_region(geojson, "test");
  EXPECT_TRUE(region.ok()) << region.error().message;
  return set_of(*plan_region(grid_of(level), earth().ellipsoid, *std::move(region), level, level));
}
std::set<TileId> tiles_in_box(const GeoRect& wanted, int level) {
  Region region;
  region.add_box(wanted);
  return set_of(*plan_region(grid_of(level), earth().ellipsoid, std::move(region), level, level));
}

glm::dvec3 direction(const MapPoint& p) {
  return Ellipsoid::normal(Angle::degrees(p.lat_deg), Angle::degrees(p.lon_deg)).xyz;
}

/// Winding number of a ring round a point, by the angles under which its great-circle edges are seen from there:
/// another way than the planner's. For rings within a hemisphere around `middle`.
bool goes_round(const std::vector<glm::dvec3>& ring, const glm::dvec3& p, const glm::dvec3& middle) {
  if (glm::dot(p, middle) <= 0.0) return false;
  double angle = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec3 a = glm::cross(p, ring[i]);
    const glm::dvec3 b = glm::cross(p, ring[(i + 1) % ring.size()]);
    angle += std::atan2(glm::dot(glm::cross(a, b), p), glm::dot(a, b));
  }
  return std::abs(angle) > std::numbers::pi;
}

/// A star of `corners` positions around a centre.
Positions star(const MapPoint& centre, double radius_deg, int corners, std::mt19937& random) {
  const glm::dvec3 n = direction(centre);
  const glm::dvec3 east =
      glm::normalize(glm::cross(std::abs(n.z) > 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1), n));
  const glm::dvec3 north = glm::cross(n, east);
  std::uniform_real_distribution<double> part(0.4, 1.0);
  Positions ring;
  for (int i = 0; i < corners; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / corners;
    const double far = Angle::degrees(radius_deg * part(random)).rad();
    const glm::dvec3 p = std::cos(far) * n + std::sin(far) * (std::cos(turn) * east + std::sin(turn) * north);
    ring.push_back({Angle::radians(std::atan2(p.y, p.x)).deg(), Angle::radians(std::asin(p.z)).deg()});
  }
  return ring;
}

/// Holds the planner to two facts: a tile with a point inside is planned, and a planned tile has a point inside or a
/// point of the edge.
void expect_as_sampled(const Positions& ring, const MapPoint& centre, int level) {
  constexpr int kEdgePoints = 4000;
  // Between two points of an edge of 90°, with the tolerance of the pieces that stand for arcs.
  constexpr double kEdge_deg = 0.5 * 90.0 / kEdgePoints + kArcTolerance_deg;
  constexpr int kSamples = 12;
  std::vector<glm::dvec3> corners;
  for (const MapPoint& p : ring) corners.push_back(direction(p));
  std::vector<MapPoint> edge;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (int k = 0; k < kEdgePoints; ++k) {
      const glm::dvec3 p = glm::normalize(glm::mix(corners[i], corners[(i + 1) % corners.size()], k / 4000.0));
      edge.push_back({Angle::radians(std::atan2(p.y, p.x)).deg(), Angle::radians(std::asin(p.z)).deg()});
    }
  }
  const std::set<TileId> planned = tiles_in(polygon_text({ring}), level);
  const TileGrid grid = grid_of(level);
  for_each_place(grid, level, [&](const TileId& id) {
    const TileBounds t = tile_bounds(grid, id);
    // Between the samples and the pole there is room for a piece of every tile of the row.
    const bool polar = id.y == 0 || id.y == rows(grid, level) - 1;
    bool inside = false;
    for (int k = 0; k < kSamples * kSamples && !inside; ++k) {
      const double u = (k % kSamples + 0.5) / kSamples;
      const double v = (k / kSamples + 0.5) / kSamples;
      const MapPoint p{glm::mix(t.west_deg, t.east_deg, u), glm::mix(t.south_deg, t.north_deg, v)};
      inside = goes_round(corners, direction(p), direction(centre));
    }
    if (inside) {
      EXPECT_TRUE(planned.contains(id)) << id.x << "," << id.y << " has a point inside";
    } else if (planned.contains(id)) {
      const bool holds_pole = polar && goes_round(corners, {0, 0, id.y == 0 ? 1 : -1}, direction(centre));
      const bool on_edge = holds_pole || std::ranges::any_of(edge, [&](const MapPoint& p) {
                             const double wide_deg =
                                 kEdge_deg / std::max(1e-6, std::cos(Angle::degrees(p.lat_deg).rad()));
                             return p.lon_deg > t.west_deg - wide_deg && p.lon_deg < t.east_deg + wide_deg &&
                                    p.lat_deg > t.south_deg - kEdge_deg && p.lat_deg < t.north_deg + kEdge_deg;
                           });
      EXPECT_TRUE(on_edge) << id.x << "," << id.y << " has nothing of the polygon";
    }
    return true;
  });
}

TEST(GeojsonRegion, PolygonsAsSampledOnTheSphere) {
  std::mt19937 random(20261121);
  const std::vector<MapPoint> centres = {{10, 45}, {-60, -20}, {179.5, 10}, {-179, -50}, {0, 89}, {120, -88}, {45, 80}};
  for (const MapPoint& centre : centres) {
    for (const double radius_deg : {3.0, 12.0, 50.0}) {
      SCOPED_TRACE(fmt::format("{},{} radius {}", centre.lon_deg, centre.lat_deg, radius_deg));
      expect_as_sampled(star(centre, radius_deg, 7, random), centre, 4);
    }
  }
}

TEST(GeojsonRegion, EdgesAreGreatCircles) {
  // From 60°N 0°E to 60°N 90°E the great circle passes 67.8°N at 45°E.
  const auto tiles = tiles_in(polygon_text({{{0, 60}, {90, 60}, {45, 60.001}}}), 7);
  const double span_deg = tile_span_deg(grid_of(7), 7);
  std::int64_t northernmost = 1000;
  for (const TileId& id : tiles) northernmost = std::min(northernmost, id.y);
  const double top_deg = 90.0 - static_cast<double>(northernmost) * span_deg;
  const double summit_deg =
      Angle::radians(std::atan(std::tan(Angle::degrees(60).rad()) / std::cos(Angle::degrees(45).rad()))).deg();
  EXPECT_GE(top_deg, summit_deg);
  EXPECT_LT(top_deg, summit_deg + span_deg);
}

TEST(GeojsonRegion, AWholePlanetAndACapWrittenAsBoxes) {
  EXPECT_EQ(tiles_in(polygon_text({{{-180, -90}, {180, -90}, {180, 90}, {-180, 90}}}), 4),
            tiles_in_box(box(-180, -90, 180, 90), 4));
  EXPECT_EQ(tiles_in(polygon_text({{{-180, 60}, {180, 60}, {180, 90}, {-180, 90}}}), 5),
            tiles_in_box(box(-180, 60, 180, 90), 5));
}

TEST(GeojsonRegion, OverTheAntimeridianEitherWayOfWriting) {
  const auto short_way = tiles_in(polygon_text({{{170, -10}, {-170, -10}, {-170, 10}, {170, 10}}}), 6);
  EXPECT_EQ(short_way, tiles_in(polygon_text({{{170, -10}, {190, -10}, {190, 10}, {170, 10}}}), 6));
  EXPECT_EQ(short_way, tiles_in(polygon_text({{{-190, -10}, {-170, -10}, {-170, 10}, {-190, 10}}}), 6));
  for (const TileId& id : short_way) EXPECT_TRUE(id.x < 4 || id.x >= 124) << id.x;
  EXPECT_TRUE(short_way.contains({6, 0, 32}));
  EXPECT_TRUE(short_way.contains({6, 127, 32}));
}

// Fiji and Antarctica of Natural Earth, whose files join the parts at ±180° with an edge of no length.
TEST(GeojsonRegion, AnEdgeFrom180ToMinus180HasNoLengthUnlessItIsASideOfABox) {
  const Positions fiji = {{180, -16.067},     {-179.795, -16.021}, {-179.917, -16.502},
                          {-180, -16.556},    {179.363, -16.801},  {178.726, -17.011},
                          {178.596, -16.639}, {179.096, -16.434},  {179.413, -16.378}};
  const Positions coast = {{-180, -84.714}, {-140, -75}, {-60, -65}, {30, -70}, {90, -66}, {150, -69}, {178, -84.5}};
  for (Positions ring : {fiji, coast}) {
    const auto expected = tiles_in(polygon_text({ring}), 5);
    ring.push_back({-ring[0].lon_deg, ring[0].lat_deg});
    EXPECT_EQ(tiles_in(polygon_text({ring}), 5), expected);
    std::ranges::reverse(ring);
    EXPECT_EQ(tiles_in(polygon_text({ring}), 5), expected);
  }
  EXPECT_LT(tiles_in(polygon_text({fiji}), 5).size(), 5U);
  const Positions band = {{-180, -10}, {180, -10}, {180, 10}, {-180, 10}};
  EXPECT_EQ(tiles_in(polygon_text({band}), 5), tiles_in_box(box(-180, -10, 180, 10), 5));
}

TEST(GeojsonRegion, RoundAPoleTheSmallerSideIsInside) {
  const Positions arctic = {{0, 80}, {90, 80}, {180, 80}, {-90, 80}};
  const Positions antarctic = {{0, -80}, {90, -80}, {180, -80}, {-90, -80}};
  const auto north = tiles_in(polygon_text({arctic}), 5);
  EXPECT_EQ(std::ranges::count(north, 0, &TileId::y), 64) << "all tiles of the first row";
  EXPECT_EQ(std::ranges::count_if(north, [](const TileId& id) { return id.y > 3; }), 0);
  const auto south = tiles_in(polygon_text({antarctic}), 5);
  EXPECT_EQ(std::ranges::count(south, 31, &TileId::y), 64);
  EXPECT_EQ(north.size(), south.size());
}

TEST(GeojsonRegion, AnEdgeExactlyOverThePole) {
  // A half cap: its straight side leads from 80°N 0°E over the pole to 80°N 180°E.
  const auto tiles = tiles_in(polygon_text({{{0, 80}, {90, 80}, {180, 80}}}), 5);
  for (const TileId& id : tiles) EXPECT_TRUE(id.x >= 32 && id.x < 64) << id.x;
  EXPECT_EQ(std::ranges::count(tiles, 0, &TileId::y), 32);
}

TEST(GeojsonRegion, HolesAndSeveralPolygons) {
  const Positions outer = {{0, 0}, {45, 0}, {45, 45}, {0, 45}};
  const Positions hole = {{11.25, 11.25}, {33.75, 11.25}, {33.75, 30}, {11.25, 30}};
  const auto whole = tiles_in(polygon_text({outer}), 6);
  const auto holed = tiles_in(polygon_text({outer, hole}), 6);
  const TileId in_hole{6, 64 + 8, 25};
  EXPECT_TRUE(whole.contains(in_hole));
  EXPECT_FALSE(holed.contains(in_hole));
  EXPECT_LT(holed.size(), whole.size());
  const std::string island = ring_text({{20, 18}, {24, 18}, {24, 22}, {20, 22}});
  const std::string both = fmt::format(R"({{"type":"MultiPolygon","coordinates":[[{},{}],[{}]]}})", ring_text(outer),
                                       ring_text(hole), island);
  EXPECT_TRUE(tiles_in(both, 6).contains(in_hole)) << "an island in the lake";
}

TEST(GeojsonRegion, APolygonInsideOneTile) {
  EXPECT_EQ(tiles_in(polygon_text({{{10, 10}, {10.01, 10}, {10.01, 10.01}}}), 3), (std::set<TileId>{{3, 8, 3}}));
}

TEST(GeojsonRegion, FeaturesAndCollections) {
  const std::string polygon = polygon_text({{{0, 0}, {10, 0}, {10, 10}}});
  const std::string feature = R"({"type":"Feature","properties":null,"geometry":)" + polygon + "}";
  const std::string nowhere = R"({"type":"Feature","properties":{},"geometry":null})";
  const auto expected = tiles_in(polygon, 5);
  EXPECT_EQ(tiles_in(feature, 5), expected);
  EXPECT_EQ(tiles_in(R"({"type":"FeatureCollection","features":[)" + nowhere + "," + feature + "]}", 5), expected);
  EXPECT_EQ(tiles_in(R"({"type":"GeometryCollection","geometries":[)" + polygon + "]}", 5), expected);
}

TEST(GeojsonRegion, ErrorsNameFileAndFeature) {
  const std::string good =
      R"({"type":"Feature","properties":{},"geometry":)" + polygon_text({{{0, 0}, {1, 0}, {1, 1}}}) + "}";
  const auto collection = [&](const std::string& bad) {
    return R"({"type":"FeatureCollection","features":[)" + good +
           R"(,{"type":"Feature","properties":{"name":"Alps"},"geometry":)" + bad + "}]}";
  };
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"", "not JSON"},
      {"{\"type\": ", "byte"},
      {"[1,2]", "no \"type\""},
      {R"({"type":"FeatureCollection"})", "features"},
      {R"({"type":"FeatureCollection","features":[]})", "no polygon"},
      {R"({"type":"Topology"})", "Topology"},
      {collection(R"({"type":"Point","coordinates":[0,0]})"), "feature 2 (\"Alps\"): its geometry is a Point"},
      {collection(R"({"type":"Polygon"})"), "without \"coordinates\""},
      {collection(R"({"type":"Polygon","coordinates":[]})"), "without rings"},
      {collection(R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[0,0]]]})"), "fewer than 4"},
      {collection(R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,1]]]})"), "not closed"},
      {collection(R"({"type":"Polygon","coordinates":[[[0,0],[1,91],[1,1],[0,0]]]})"), "1,91 is not on the planet"},
      {collection(R"({"type":"Polygon","coordinates":[[[0,0],[500000,4000000],[1,1],[0,0]]]})"), "longitude first"},
      {collection(R"({"type":"Polygon","coordinates":[[[0,0],["a",1],[1,1],[0,0]]]})"), "not [longitude, latitude]"},
      {collection(R"({"type":"Polygon","coordinates":[[[0,10],[180,-10],[90,0],[0,10]]]})"), "antipodal"},
      {collection(R"({"type":"MultiPolygon","coordinates":7})"), "coordinates"},
      {collection("7"), "feature 2"},
  };
  for (const auto& [text, says] : wrong) {
    const auto region = parse_geojson_region(text, "alps.geojson");
    ASSERT_FALSE(region.ok()) << text;
    EXPECT_TRUE(region.error().message.starts_with("alps.geojson: ")) << region.error().message;
    EXPECT_NE(region.error().message.find(says), std::string::npos) << region.error().message;
  }
}

TEST(GeojsonRegion, EqualRingsCostNoMoreThanOne) {
  const Positions square = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  const auto one = parse_geojson_region(polygon_text({square}), "f");
  const auto many = parse_geojson_region(polygon_text(std::vector(1001, square)), "f");
  ASSERT_TRUE(one.ok() && many.ok());
  EXPECT_EQ(many->whole().segments.size(), one->whole().segments.size());
  const auto even = parse_geojson_region(polygon_text(std::vector(1000, square)), "f");
  ASSERT_FALSE(even.ok());
  EXPECT_NE(even.error().message.find("cancel each other"), std::string::npos) << even.error().message;
}

TEST(GeojsonRegion, AWalkLooksOnlyAtTheEdgesThatItsTilesTouch) {
  // A comb along the equator: each tile touches a few of its edges, though all edges span the same latitudes.
  Region comb;
  constexpr int kTeeth = 2000;
  MapRing ring;
  for (int k = 0; k < kTeeth; ++k) ring.push_back({-100.0 + 200.0 * k / kTeeth, k % 2 == 0 ? -1.0 : 1.0});
  ring.insert(ring.end(), {{100.0, -2.0}, {-100.0, -2.0}});
  comb.add_polygon({ring});
  Region::Sight seen, below;
  EXPECT_EQ(comb.classify({0.01, -0.5, 1.0, 0.5}, comb.whole(), seen), Overlap::cut);
  EXPECT_LT(seen.segments.size(), 20U);
  EXPECT_EQ(comb.classify({0.02, -0.3, 0.03, 0.3}, seen, below), Overlap::outside);
}

TEST(GeojsonRegion, ARingMayGoRoundManyTimesAndBack) {
  // 1000 turns east along the equator and as many back: a long ring without area, which is no reason to hang.
  Positions ring;
  for (int k = 0; k <= 3000; ++k) ring.push_back({std::remainder(120.0 * k, 360.0), 0.0});
  for (int k = 2999; k > 0; --k) ring.push_back({std::remainder(120.0 * k, 360.0), 0.0});
  const auto parts = rings_of(ring);
  ASSERT_TRUE(parts.ok());
  EXPECT_EQ(parts->size(), 1001U);
  for (const MapRing& part : *parts) {
    for (const MapPoint& p : part) ASSERT_LE(std::abs(p.lon_deg), 180.0);
  }
}

TEST(GeojsonRegion, AnEdgeThatNeedsTooManyPointsIsRefusedBeforeTheyAreMade) {
  Positions ring;
  for (int k = 0; k < 30000; ++k) ring.push_back({k % 3 * 120.0 - 120.0, 45.0});
  const auto region = parse_geojson_region(polygon_text({ring}), "f");
  ASSERT_FALSE(region.ok());
  EXPECT_NE(region.error().message.find("simplify"), std::string::npos) << region.error().message;
}

TEST(GeojsonRegion, AFileThatIsNotThereIsNamed) {
  const auto region = read_geojson_region("/nowhere/area.geojson");
  ASSERT_FALSE(region.ok());
  EXPECT_NE(region.error().message.find("/nowhere/area.geojson"), std::string::npos);
}

}  // namespace
}  // namespace terrella
