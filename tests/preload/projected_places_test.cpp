#include "streaming/preload/projected_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "geo/body.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {
namespace {

constexpr int kFinest = 5;

TileSetInfo polar(const std::string& crs) {
  constexpr double kHalf_m = 4194304.0;
  TileSetInfo info;
  info.square = CrsSquare{.crs = crs, .west = -kHalf_m, .north = kHalf_m, .unit_per_deg = 2.0 * kHalf_m / 360.0};
  info.grid = {.root_span_deg = 360.0, .max_level = kFinest, .projection = Projection::projected};
  info.grid.bounds = {.south = Angle::degrees(-180.0), .north = Angle::degrees(180.0)};
  return info;
}

GeoRect box_of(double west, double south, double east, double north) {
  return {Angle::degrees(west), Angle::degrees(south), Angle::degrees(east), Angle::degrees(north)};
}

std::set<TileId> planned(const TileSetInfo& info, Region region) {
  const auto places = ProjectedPlaces::open(info);
  EXPECT_TRUE(places);
  const auto plan = plan_region(info.grid, earth().ellipsoid, std::move(region), kFinest, kFinest, *places);
  std::set<TileId> tiles;
  const auto feed = plan->walk();
  while (const auto run = feed->next()) {
    for (std::int64_t y = run->first_y; y <= run->last_y; ++y) tiles.insert({run->level, run->x, y});
  }
  EXPECT_EQ(plan->total(), static_cast<std::int64_t>(tiles.size()));
  return tiles;
}

std::set<TileId> planned(const TileSetInfo& info, const GeoRect& box) {
  Region region;
  region.add_box(box);
  return planned(info, std::move(region));
}

/// A box as polygons with many points.
Region as_polygons(const GeoRect& box) {
  Region region;
  const auto add = [&](double west, double east) {
    constexpr int kSide = 50;
    const double south = box.south.deg(), north = box.north.deg();
    MapRing ring;
    ring.reserve(2 * kSide);
    for (int i = 0; i < kSide; ++i) ring.push_back({std::lerp(west, east, i / (kSide - 1.0)), south});
    for (int i = 0; i < kSide; ++i) ring.push_back({std::lerp(east, west, i / (kSide - 1.0)), north});
    region.add_polygon({ring});
  };
  if (box.west <= box.east) {
    add(box.west.deg(), box.east.deg());
  } else {
    add(box.west.deg(), 180.0);
    add(-180.0, box.east.deg());
  }
  return region;
}

/// Tiles of the finest level that hold one of many points of a box.
std::set<TileId> touched(const TileSetInfo& info, const GeoRect& box) {
  constexpr int kSide = 400;
  const double width = box.east.deg() - box.west.deg() + (box.east < box.west ? 360.0 : 0.0);
  std::vector<CrsPoint> places;
  places.reserve(std::size_t{kSide} * kSide);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      places.push_back({box.west.deg() + width * (column + 0.5) / kSide,
                        box.south.deg() + (box.north.deg() - box.south.deg()) * (row + 0.5) / kSide});
    }
  }
  const auto crs = Crs::open(info.square->crs);
  const auto points = crs->points(places);
  const double span = 360.0 * info.square->unit_per_deg / (1 << kFinest);
  std::set<TileId> tiles;
  for (const CrsPoint& point : *points) {
    const TileId id{kFinest, static_cast<std::int64_t>(std::floor((point.x - info.square->west) / span)),
                    static_cast<std::int64_t>(std::floor((info.square->north - point.y) / span))};
    if (exists(info.grid, id)) tiles.insert(id);
  }
  return tiles;
}

TEST(ProjectedPlaces, APlanHasEachTileOfAnAreaAndFewBesides) {
  for (const auto& [crs, box] :
       {std::pair("EPSG:3413", box_of(170, 60, -165, 70)), std::pair("EPSG:3413", box_of(-180, 78, 180, 90)),
        std::pair("EPSG:3413", box_of(10, 50, 24, 61)), std::pair("EPSG:3031", box_of(-70, -80, -50, -60)),
        std::pair("EPSG:3031", box_of(150, -90, -120, -70))}) {
    SCOPED_TRACE(std::string(crs) + " from " + std::to_string(box.west.deg()));
    const std::set<TileId> tiles = planned(polar(crs), box), needed = touched(polar(crs), box);
    EXPECT_GT(needed.size(), 8U);
    for (const TileId& id : needed) EXPECT_TRUE(tiles.contains(id)) << id.x << " " << id.y;
    // Tiles beside the edge of the area: at most about one more round it.
    EXPECT_LE(static_cast<double>(tiles.size()), 1.6 * static_cast<double>(needed.size()));
    EXPECT_EQ(planned(polar(crs), as_polygons(box)), tiles);
  }
}

TEST(ProjectedPlaces, AnAreaOnTheOtherSideHasNoTiles) {
  EXPECT_TRUE(planned(polar("EPSG:3413"), box_of(-60, -40, -20, -20)).empty());
}

TEST(ProjectedPlaces, ASystemWithoutPlacesIsRefused) {
  const auto places = ProjectedPlaces::open(
      polar(R"(PROJCRS["Own",BASEGEOGCRS["WGS 84",DATUM["World Geodetic System 1984",)"
            R"(ELLIPSOID["WGS 84",6378137,298.257223563]]],CONVERSION["Own",METHOD["Nobody's"]],CS[Cartesian,2],)"
            R"(AXIS["easting",east],AXIS["northing",north],LENGTHUNIT["metre",1]])"));
  ASSERT_FALSE(places);
  EXPECT_NE(places.error().message.find("no place of its tiles in the system Own"), std::string::npos)
      << places.error().message;
}

}  // namespace
}  // namespace terrella
