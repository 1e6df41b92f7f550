#include <gtest/gtest.h>

#include <cmath>

#include "streaming/sets/open_tile_set.h"
#include "streaming_test_support.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using test::run_sql;
using test::ScratchFolder;

constexpr int kMbtilePx = 32;
constexpr double kMbtileRounding = 0.51;  // rounding of colours to 8 bits

std::string metadata(const std::string& name, const std::string& value) {
  return "INSERT INTO metadata VALUES ('" + name + "', '" + value + "');";
}

constexpr const char* kTables =
    "CREATE TABLE metadata (name TEXT, value TEXT);"
    "CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data, UNIQUE (zoom_level, tile_column, tile_row));";

/// Tiles of a grid that show the places that they cover, rows from the south.
void write_mbtiles(const fs::path& path, const TileGrid& grid, const std::string& more) {
  run_sql(path, kTables + metadata("name", "Planet") + more);
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    const auto from_south = std::llround(180.0 / tile_span_deg(grid, level)) - 1;
    for_each_place(grid, level, [&](const TileId& id) {
      test::insert_tile(path, level, id.x, from_south - id.y, *encode_png(test::place_tile(grid, id)));
      return true;
    });
  }
}

void expect_places(const fs::path& path, double root_span_deg, int min_level) {
  const auto source = open_tile_set(path);
  ASSERT_TRUE(source) << source.error().message;
  const TileGrid& grid = (*source)->info().grid;
  EXPECT_EQ(grid.root_span_deg, root_span_deg);
  EXPECT_EQ(grid.min_level, min_level);
  EXPECT_EQ(grid.max_level, 2);
  EXPECT_EQ(grid.tile_px, kMbtilePx);
  EXPECT_EQ((*source)->info().format, ImageFormat::png);
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    EXPECT_EQ((*source)->count_tiles(level), count_places(grid, level));
    for_each_place(grid, level, [&](const TileId& id) {
      const Image tile = test::load_tile(**source, id);
      EXPECT_EQ(tile.width_px, kMbtilePx);
      EXPECT_LE(test::worst_misplacement(grid, id, tile), kMbtileRounding);
      return true;
    });
  }
}

void expect_mbtiles_refused(const fs::path& path, const std::string& why) {
  const auto source = open_tile_set(path);
  ASSERT_FALSE(source);
  EXPECT_TRUE(source.error().message.starts_with(path.string())) << source.error().message;
  EXPECT_NE(source.error().message.find(why), std::string::npos) << source.error().message;
}

TEST(Mbtiles, TilesAreWhereTheyShouldBeWithTwoRootsOrOne) {
  const ScratchFolder folder;
  const TileGrid two{.root_span_deg = 180.0, .tile_px = kMbtilePx, .max_level = 2};
  write_mbtiles(folder / "two.mbtiles", two, metadata("profile", "geodetic"));
  expect_places(folder / "two.mbtiles", 180.0, 0);
  const TileGrid one{.root_span_deg = 360.0, .tile_px = kMbtilePx, .min_level = 1, .max_level = 2};
  write_mbtiles(folder / "one.mbtiles", one, metadata("crs", "EPSG:4326"));
  expect_places(folder / "one.mbtiles", 360.0, 1);
}

TEST(Mbtiles, MustSayThatItIsGeodetic) {
  const ScratchFolder folder;
  const TileGrid grid{.root_span_deg = 180.0, .tile_px = kMbtilePx, .max_level = 1};
  write_mbtiles(folder / "silent.mbtiles", grid, "");
  expect_mbtiles_refused(folder / "silent.mbtiles", "'profile', 'geodetic'");
  EXPECT_TRUE(open_tile_set(folder / "silent.mbtiles", true));
  write_mbtiles(folder / "web.mbtiles", grid, metadata("srs", "EPSG:3857"));
  expect_mbtiles_refused(folder / "web.mbtiles", "it should be in Web Mercator, but level 1 has columns 0 to 3");
  write_mbtiles(folder / "utm.mbtiles", grid, metadata("crs", "EPSG:32632"));
  expect_mbtiles_refused(folder / "utm.mbtiles", "its crs is EPSG:32632");
  expect_mbtiles_refused(folder / "utm.mbtiles", "‹cut›");
  write_mbtiles(folder / "srs.mbtiles", grid, metadata("srs", "CRS:84"));
  EXPECT_TRUE(open_tile_set(folder / "srs.mbtiles"));
}

TEST(Mbtiles, TilesBeyondThePlanetAreOfAnotherGrid) {
  const ScratchFolder folder;
  const TileGrid grid{.root_span_deg = 180.0, .tile_px = kMbtilePx, .max_level = 1};
  const auto png = *encode_png(test::gradient(kMbtilePx, kMbtilePx));
  struct Place {
    int column, row;
  };
  for (const Place place : {Place{4, 0}, Place{0, 2}}) {
    const fs::path file = folder / (std::to_string(place.column) + "_" + std::to_string(place.row) + ".mbtiles");
    write_mbtiles(file, grid, metadata("profile", "geodetic"));
    test::insert_tile(file, 1, place.column, place.row, png);
    expect_mbtiles_refused(file, "a grid of its own");
    expect_mbtiles_refused(file, "at most 4 and 2");
    expect_mbtiles_refused(file, "‹cut›");
  }
}

TEST(Mbtiles, StrayTilesUnderZeroAreLeftOut) {
  const ScratchFolder folder;
  const TileGrid grid{.root_span_deg = 180.0, .tile_px = kMbtilePx, .max_level = 1};
  const fs::path file = folder / "stray.mbtiles";
  write_mbtiles(file, grid, metadata("profile", "geodetic"));
  test::insert_tile(file, 1, -1, 0, *encode_png(test::gradient(kMbtilePx, kMbtilePx)));
  const auto source = open_tile_set(file);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->info().grid.max_level, 1);
  ASSERT_EQ((*source)->info().remarks.size(), 1U);
  EXPECT_NE((*source)->info().remarks[0].find("level 1, column -1, row 0"), std::string::npos);
}

TEST(Mbtiles, BoundsOfItsMetadataNarrowIt) {
  const ScratchFolder folder;
  const TileGrid west{.root_span_deg = 180.0,
                      .tile_px = kMbtilePx,
                      .max_level = 2,
                      .bounds = {.east = Angle::degrees(0.0), .north = Angle::degrees(0.0)}};
  write_mbtiles(folder / "part.mbtiles", west, metadata("profile", "geodetic") + metadata("bounds", "-180,-90,0,0"));
  const auto source = open_tile_set(folder / "part.mbtiles");
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->info().grid.root_span_deg, 180.0);
  const auto absent = (*source)->read({2, 7, 0});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().kind, MissingKind::absent);
  EXPECT_TRUE((*source)->read({2, 0, 3}));
}

TEST(Mbtiles, HostileFilesAreRefused) {
  const ScratchFolder folder;
  const std::string geodetic = kTables + metadata("profile", "geodetic");
  run_sql(folder / "empty.mbtiles", geodetic);
  expect_mbtiles_refused(folder / "empty.mbtiles", "no tiles");
  run_sql(folder / "vector.mbtiles", geodetic + "INSERT INTO tiles VALUES (0, 0, 0, x'1F8B0800');");
  expect_mbtiles_refused(folder / "vector.mbtiles", "not JPEG, PNG or WebP");
  run_sql(folder / "cut.mbtiles", geodetic + "INSERT INTO tiles VALUES (0, 0, 0, x'FFD8FFE0');");
  expect_mbtiles_refused(folder / "cut.mbtiles", "its first tile");
  run_sql(folder / "deep.mbtiles", geodetic);
  test::insert_tile(folder / "deep.mbtiles", 60, 0, 0, *encode_png(test::gradient(32, 32)));
  expect_mbtiles_refused(folder / "deep.mbtiles", "zoom levels are 60 to 60");
  run_sql(folder / "wide.mbtiles", geodetic);
  test::insert_tile(folder / "wide.mbtiles", 0, 0, 0, *encode_png(test::gradient(32, 16)));
  expect_mbtiles_refused(folder / "wide.mbtiles", "not square");
  run_sql(folder / "endless.mbtiles",
          "CREATE TABLE metadata (name, value);" + metadata("profile", "geodetic") +
              "CREATE VIEW tiles AS WITH RECURSIVE n(i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM n) "
              "SELECT i AS zoom_level, 0 AS tile_column, 0 AS tile_row, CASE WHEN i < 0 THEN x'FF' END AS tile_data "
              "FROM n;");
  expect_mbtiles_refused(folder / "endless.mbtiles", "takes too long");
}

}  // namespace
}  // namespace terrella
