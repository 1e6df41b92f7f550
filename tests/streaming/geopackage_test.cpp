#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <thread>

#include "streaming/sets/open_tile_set.h"
#include "streaming/sets/tileset_json.h"
#include "streaming_test_support.h"
#include "tiles/tile_range.h"
#include "tiles/tile_source.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using test::insert_tile;
using test::run_sql;
using test::ScratchFolder;

constexpr int kPackagedPx = 32;
constexpr double kPackagedRounding = 0.51;  // rounding of colours to 8 bits

/// A tile matrix set: its corner and extent, and the span of the tile and the size of the matrix of each zoom level.
struct Zoom {
  int zoom;
  double span_deg;
  int columns, rows;
};
struct MatrixSet {
  double west = -180, south = -90, east = 180, north = 90;
  std::vector<Zoom> zooms = {{0, 180, 2, 1}, {1, 90, 4, 2}};
  int srs = 4326;
};

std::string tables() {
  return "CREATE TABLE gpkg_spatial_ref_sys (srs_name, srs_id, organization, organization_coordsys_id, definition);"
         "INSERT INTO gpkg_spatial_ref_sys VALUES ('WGS 84', 4326, 'EPSG', 4326, ''), ('Web', 3857, 'EPSG', 3857, ''),"
         " ('mine', 100001, 'epsg', 4326, '');"
         "CREATE TABLE gpkg_contents (table_name, data_type, identifier, description, min_x, min_y, max_x, max_y, "
         "srs_id);"
         "CREATE TABLE gpkg_tile_matrix_set (table_name, srs_id, min_x, min_y, max_x, max_y);"
         "CREATE TABLE gpkg_tile_matrix (table_name, zoom_level, matrix_width, matrix_height, tile_width, tile_height,"
         " pixel_x_size, pixel_y_size);"
         "CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data, UNIQUE (zoom_level, tile_column, "
         "tile_row));";
}

std::string number(double value) { return std::to_string(value); }

/// A GeoPackage whose tiles show the places that they cover.
void write_geopackage(const fs::path& path, const MatrixSet& set) {
  const std::string extent =
      number(set.west) + "," + number(set.south) + "," + number(set.east) + "," + number(set.north);
  std::string sql = tables() + "INSERT INTO gpkg_contents VALUES ('tiles', 'tiles', 'Planet', 'by someone', " + extent +
                    ", " + std::to_string(set.srs) + "); INSERT INTO gpkg_tile_matrix_set VALUES ('tiles', " +
                    std::to_string(set.srs) + ", " + extent + ");";
  for (const Zoom& zoom : set.zooms) {
    const std::string pixel = number(zoom.span_deg / kPackagedPx);
    sql += "INSERT INTO gpkg_tile_matrix VALUES ('tiles', " + std::to_string(zoom.zoom) + ", " +
           std::to_string(zoom.columns) + ", " + std::to_string(zoom.rows) + ", 32, 32, " + pixel + ", " + pixel + ");";
  }
  run_sql(path, sql);
  for (const Zoom& zoom : set.zooms) {
    for (int row = 0; row < zoom.rows; ++row) {
      for (int column = 0; column < zoom.columns; ++column) {
        // A grid of one column whose tile 0/0/0 is where this tile is: only the bounds' corner differs.
        const double west = set.west + column * zoom.span_deg;
        const double wrapped_west = west >= 180.0 ? west - 360.0 : west;
        const double north = set.north - row * zoom.span_deg;
        TileGrid grid{.root_span_deg = zoom.span_deg, .tile_px = kPackagedPx};
        const TileId id{0, std::llround((wrapped_west + 180.0) / zoom.span_deg),
                        std::llround((90.0 - north) / zoom.span_deg)};
        insert_tile(path, zoom.zoom, column, row, *encode_png(test::place_tile(grid, id)));
      }
    }
  }
}

std::unique_ptr<TileSource> open(const fs::path& path) {
  auto source = open_tile_set(path);
  EXPECT_TRUE(source) << source.error().message;
  return source ? *std::move(source) : nullptr;
}

void expect_package_refused(const fs::path& path, const std::string& says) {
  const auto source = open_tile_set(path);
  ASSERT_FALSE(source) << path;
  EXPECT_EQ(source.error().message.rfind(path.string(), 0), 0U) << source.error().message;
  EXPECT_NE(source.error().message.find(says), std::string::npos) << source.error().message;
}

/// Every tile of the set is there and shows the places that the grid says it covers.
void expect_places(TileSource& source) {
  const TileGrid& grid = source.info().grid;
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    for_each_place(grid, level, [&](const TileId& id) {
      EXPECT_LE(test::worst_misplacement(grid, id, test::load_tile(source, id)), kPackagedRounding)
          << id.level << "/" << id.x << "/" << id.y;
      return true;
    });
    EXPECT_EQ(source.count_tiles(level), count_places(grid, level));
  }
}

TEST(GeoPackage, AWorldFromItsCornerIsRead) {
  const ScratchFolder folder;
  write_geopackage(folder / "a.gpkg", {});
  const auto source = open(folder / "a.gpkg");
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().name, "Planet");
  EXPECT_EQ(source->info().attribution, "by someone");
  EXPECT_EQ(source->info().format, ImageFormat::png);
  EXPECT_EQ(source->info().grid, (TileGrid{.root_span_deg = 180, .tile_px = kPackagedPx, .max_level = 1}));
  expect_places(*source);
}

TEST(GeoPackage, OtherZoomNumbersAreTaken) {
  const ScratchFolder folder;
  write_geopackage(folder / "late.gpkg", {.zooms = {{17, 180, 2, 1}, {18, 90, 4, 2}, {19, 45, 8, 4}}});
  const auto source = open(folder / "late.gpkg");
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().grid.max_level - source->info().grid.min_level, 2);
  expect_places(*source);
}

TEST(GeoPackage, ACornerWholeTilesAwayIsAnOffset) {
  const ScratchFolder folder;
  write_geopackage(folder / "part.gpkg",
                   {.west = -90, .south = -45, .east = 90, .north = 45, .zooms = {{0, 45, 4, 2}, {1, 22.5, 8, 4}}});
  const auto part = open(folder / "part.gpkg");
  ASSERT_TRUE(part);
  EXPECT_NEAR(part->info().grid.bounds.west.deg(), -90.0, 1e-9);
  expect_places(*part);
  EXPECT_EQ(part->read({part->info().grid.min_level, 0, 0}).error().kind, MissingKind::absent);
}

TEST(GeoPackage, CoarseLevelsBetweenTilesAreLeftOut) {
  // GoogleCRS84Quad as GDAL has it: one root tile from (-180°, 180°).
  const ScratchFolder folder;
  write_geopackage(folder / "google.gpkg",
                   {.south = -180, .north = 180, .zooms = {{0, 360, 1, 1}, {1, 180, 2, 2}, {2, 90, 4, 4}}});
  const auto source = open(folder / "google.gpkg");
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().grid.min_level, 2);
  EXPECT_EQ(source->info().grid.max_level, 2);
  for_each_place(source->info().grid, 2, [&](const TileId& id) {
    EXPECT_LE(test::worst_misplacement(source->info().grid, id, test::load_tile(*source, id)), kPackagedRounding);
    return true;
  });
}

TEST(GeoPackage, LongitudesFromZeroTo360ComeRound) {
  const ScratchFolder folder;
  write_geopackage(folder / "l360.gpkg", {.west = 0, .east = 360});
  const auto source = open(folder / "l360.gpkg");
  ASSERT_TRUE(source);
  expect_places(*source);
  write_geopackage(folder / "pacific.gpkg", {.west = 90, .south = 0, .east = 270, .zooms = {{0, 90, 2, 1}}});
  const auto pacific = open(folder / "pacific.gpkg");
  ASSERT_TRUE(pacific);
  EXPECT_NEAR(pacific->info().grid.bounds.east.deg(), -90.0, 1e-9);
  expect_places(*pacific);
}

TEST(GeoPackage, AnotherNumberForEpsg4326IsTaken) {
  const ScratchFolder folder;
  write_geopackage(folder / "mine.gpkg", {.srs = 100001});
  ASSERT_TRUE(open(folder / "mine.gpkg"));
}

TEST(GeoPackage, OursKeepsWhatGeoPackageCannotSay) {
  const ScratchFolder folder;
  const fs::path path = folder / "ours.gpkg";
  write_geopackage(path, {.west = -180,
                          .south = -198,
                          .east = 396,
                          .north = 90,
                          .zooms = {{0, 288, 2, 1}, {1, 144, 4, 2}},
                          .srs = 100001});
  TileSetInfo info;
  info.name = "Mars";
  info.body = "mars";
  info.grid = {.root_span_deg = 288.0, .tile_px = kPackagedPx, .max_level = 1, .latitude = LatitudeKind::centric};
  info.format = ImageFormat::png;
  run_sql(path,
          "CREATE TABLE terrella_tileset (key TEXT PRIMARY KEY, value TEXT); INSERT INTO terrella_tileset VALUES "
          "('tileset', '" +
              to_tileset_json(info) + "')");
  const auto source = open(path);
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().name, "Mars");
  EXPECT_EQ(source->info().grid, info.grid);
  EXPECT_LE(test::worst_misplacement(info.grid, {1, 2, 1}, test::load_tile(*source, {1, 2, 1})), kPackagedRounding);
  run_sql(path, "UPDATE terrella_tileset SET value = replace(value, '288.0', '180.0')");
  expect_package_refused(path, "level 0 has tiles of 180°");
  run_sql(path, "UPDATE terrella_tileset SET value = x'07'");
  expect_package_refused(path, "terrella_tileset: no text");
}

TEST(GeoPackage, LevelsWithoutTilesAtTheTopAreLeftOut) {
  const ScratchFolder folder;
  write_geopackage(folder / "fine.gpkg", {});
  run_sql(folder / "fine.gpkg", "DELETE FROM tiles WHERE zoom_level = 0");
  EXPECT_EQ(open(folder / "fine.gpkg")->info().grid.min_level, 1);
  run_sql(folder / "fine.gpkg", "DELETE FROM tiles");
  expect_package_refused(folder / "fine.gpkg", "holds no tiles");
}

TEST(GeoPackage, TooManyRootTilesAskForOverviews) {
  const ScratchFolder folder;
  write_geopackage(folder / "flat.gpkg", {.zooms = {}});
  run_sql(folder / "flat.gpkg",
          "INSERT INTO gpkg_tile_matrix VALUES ('tiles', 6, 64, 32, 32, 32, 0.17578125, 0.17578125)");
  insert_tile(folder / "flat.gpkg", 6, 0, 0, *encode_png(test::gradient(kPackagedPx, kPackagedPx)));
  expect_package_refused(folder / "flat.gpkg", "gdaladdo");
}

TEST(GeoPackage, TilesOfARegionBeginAnywhere) {
  const ScratchFolder folder;
  write_geopackage(folder / "shifted.gpkg",
                   {.west = -100, .south = -40, .east = 80, .north = 50, .zooms = {{0, 90, 2, 1}, {1, 45, 4, 2}}});
  const auto source = open(folder / "shifted.gpkg");
  const TileGrid& grid = source->info().grid;
  EXPECT_EQ(grid.west_deg, -190.0);
  EXPECT_EQ(grid.north_deg, 140.0);
  // The table's first tile is the second column and the second row from the origin, in steps of 90°.
  const TileBounds first = tile_bounds(grid, {grid.min_level, 1, 1});
  EXPECT_EQ(first.west_deg, -100.0);
  EXPECT_EQ(first.north_deg, 50.0);
  EXPECT_TRUE(exists(grid, {grid.min_level, 1, 1}));
  EXPECT_FALSE(exists(grid, {grid.min_level, 0, 1}));
}

TEST(GeoPackage, SetsThatNoGridDescribesAreRefusedWithTheReason) {
  const ScratchFolder folder;
  write_geopackage(folder / "thirds.gpkg", {.zooms = {{0, 180, 2, 1}, {1, 60, 6, 3}}});
  expect_package_refused(folder / "thirds.gpkg", "do not halve");
  write_geopackage(folder / "between.gpkg",
                   {.west = -170, .south = -90, .east = 190, .north = 90, .zooms = {{0, 180, 2, 1}}});
  expect_package_refused(folder / "between.gpkg", "no whole number of tiles");
  write_geopackage(folder / "mercator.gpkg", {.srs = 3857});
  expect_package_refused(folder / "mercator.gpkg", "TILING_SCHEME=GoogleMapsCompatible");
  write_geopackage(folder / "utm.gpkg", {.srs = 32632});
  expect_package_refused(folder / "utm.gpkg", "srs_id 32632: gpkg_spatial_ref_sys gives it no known code");
}

/// SQL that makes a good GeoPackage bad, and a word of the message.
struct Damage {
  const char* sql;
  const char* says;
};

TEST(GeoPackage, HostileOnesAreRefused) {
  const Damage damages[] = {
      {"DROP TABLE gpkg_contents", "gpkg_contents"},
      {"DELETE FROM gpkg_contents", "without tiles"},
      {"UPDATE gpkg_contents SET data_type = '2d-gridded-coverage'", "gpkg_2d_gridded_coverage_ancillary"},
      {"UPDATE gpkg_contents SET table_name = NULL; UPDATE gpkg_tile_matrix_set SET table_name = NULL",
       "without tiles"},
      {"UPDATE gpkg_contents SET table_name = 5; UPDATE gpkg_tile_matrix_set SET table_name = 5", "table_name"},
      {"DROP TABLE gpkg_tile_matrix_set", "gpkg_tile_matrix_set"},
      {"UPDATE gpkg_tile_matrix_set SET srs_id = 'four'", "srs_id"},
      {"UPDATE gpkg_tile_matrix_set SET min_x = NULL", "min_x"},
      {"UPDATE gpkg_tile_matrix_set SET min_x = 'west'", "min_x"},
      {"UPDATE gpkg_tile_matrix_set SET max_x = -9e999", "min_x"},
      {"UPDATE gpkg_tile_matrix_set SET max_x = 1e30", "min_x"},
      {"UPDATE gpkg_tile_matrix_set SET max_y = -91", "min_x"},
      {"DROP TABLE gpkg_tile_matrix", "gpkg_tile_matrix"},
      {"DELETE FROM gpkg_tile_matrix", "no zoom level"},
      {"UPDATE gpkg_tile_matrix SET zoom_level = -1", "zoom_level"},
      {"UPDATE gpkg_tile_matrix SET zoom_level = 1.5", "zoom_level"},
      {"UPDATE gpkg_tile_matrix SET zoom_level = 9223372036854775807", "zoom_level"},
      {"UPDATE gpkg_tile_matrix SET matrix_width = 1152921504606846976", "matrix_width"},
      {"UPDATE gpkg_tile_matrix SET matrix_width = 1000000000000", "do not fill"},
      {"UPDATE gpkg_tile_matrix SET matrix_height = 0", "matrix_height"},
      {"UPDATE gpkg_tile_matrix SET matrix_width = '2x'", "matrix_width"},
      {"UPDATE gpkg_tile_matrix SET tile_width = 64", "tile_width"},
      {"UPDATE gpkg_tile_matrix SET tile_width = 1000000000, tile_height = 1000000000", "tile_width"},
      {"UPDATE gpkg_tile_matrix SET pixel_x_size = 0", "pixel_x_size"},
      {"UPDATE gpkg_tile_matrix SET pixel_y_size = x'00'", "pixel_y_size"},
      {"UPDATE gpkg_tile_matrix SET pixel_x_size = pixel_x_size * 2", "not square"},
      {"UPDATE gpkg_tile_matrix SET zoom_level = 3, matrix_width = 2, matrix_height = 1, pixel_x_size = 5.625,"
       " pixel_y_size = 5.625",
       "do not halve"},
      {"WITH RECURSIVE n(i) AS (SELECT 2 UNION ALL SELECT i + 1 FROM n LIMIT 100) INSERT INTO gpkg_tile_matrix SELECT "
       "'tiles',"
       " i % 60, 2, 1, 32, 32, 5.625, 5.625 FROM n",
       "more than 64"},
      {"DROP TABLE tiles", "no such table"},
      {"DROP TABLE tiles; CREATE TABLE tiles (something)", "no such column"},
      {"UPDATE gpkg_contents SET table_name = 'a\"; DROP TABLE tiles; --'; UPDATE gpkg_tile_matrix_set SET table_name "
       "= "
       "'a\"; DROP TABLE tiles; --'; UPDATE gpkg_tile_matrix SET table_name = 'a\"; DROP TABLE tiles; --'",
       "no such table"},
      {"CREATE TABLE terrella_tileset (other)", "terrella_tileset"},
      {"CREATE TABLE terrella_tileset (key, value)", "terrella_tileset: no text"},
      {"CREATE TABLE terrella_tileset (key, value); INSERT INTO terrella_tileset VALUES ('tileset', '{}')",
       "root_span_deg"},
  };
  const ScratchFolder folder;
  write_geopackage(folder / "good.gpkg", {});
  ASSERT_TRUE(open(folder / "good.gpkg"));
  for (const Damage& damage : damages) {
    SCOPED_TRACE(damage.sql);
    const fs::path path = folder / "bad.gpkg";
    fs::copy_file(folder / "good.gpkg", path, fs::copy_options::overwrite_existing);
    run_sql(path, damage.sql);
    expect_package_refused(path, damage.says);
  }
}

TEST(GeoPackage, WhatIsNoGeoPackageIsNamed) {
  const ScratchFolder folder;
  run_sql(folder / "other.db", "CREATE TABLE recipes (name)");
  expect_package_refused(folder / "other.db", "neither a GeoPackage");
  run_sql(folder / "a.mbtiles",
          "CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data);"
          "CREATE TABLE metadata (name, value)");
  expect_package_refused(folder / "a.mbtiles", "MBTiles");
  write_geopackage(folder / "whole.gpkg", {});
  fs::resize_file(folder / "whole.gpkg", 5000);
  expect_package_refused(folder / "whole.gpkg", "whole.gpkg");
  test::write_text(folder / "magic.gpkg", std::string_view("SQLite format 3\0", 16));
  expect_package_refused(folder / "magic.gpkg", "GeoPackage");
}

TEST(GeoPackage, MissingIsTyped) {
  const ScratchFolder folder;
  const fs::path path = folder / "holes.gpkg";
  write_geopackage(path, {});
  run_sql(path,
          "DELETE FROM tiles WHERE zoom_level = 1 AND tile_column = 0 AND tile_row = 0;"
          "UPDATE tiles SET tile_data = x'' WHERE zoom_level = 1 AND tile_column = 1 AND tile_row = 0;"
          "UPDATE tiles SET tile_data = NULL WHERE zoom_level = 1 AND tile_column = 2 AND tile_row = 0;"
          "UPDATE tiles SET tile_data = 'text' WHERE zoom_level = 1 AND tile_column = 3 AND tile_row = 0;"
          "UPDATE tiles SET tile_data = zeroblob(40000000) WHERE zoom_level = 1 AND tile_column = 0 AND tile_row = 1;");
  const auto source = open(path);
  ASSERT_TRUE(source);
  const auto kind = [&](const TileId& id) { return source->read(id).error().kind; };
  EXPECT_EQ(kind({1, 0, 0}), MissingKind::absent);
  EXPECT_EQ(kind({1, 1, 0}), MissingKind::blank);
  EXPECT_EQ(kind({1, 2, 0}), MissingKind::broken);
  EXPECT_EQ(kind({1, 3, 0}), MissingKind::broken);
  EXPECT_EQ(kind({1, 0, 1}), MissingKind::broken);  // over the limit for one tile
  EXPECT_EQ(kind({2, 0, 0}), MissingKind::absent);
  EXPECT_EQ(kind({1, 4, 0}), MissingKind::absent);
  EXPECT_EQ(kind({1, 0, -1}), MissingKind::absent);
}

TEST(GeoPackage, AViewWithoutEndIsGivenUp) {
  const ScratchFolder folder;
  const fs::path path = folder / "endless.gpkg";
  write_geopackage(path, {});
  run_sql(
      path,
      "DROP TABLE gpkg_tile_matrix_set; CREATE VIEW gpkg_tile_matrix_set AS WITH RECURSIVE n(i) AS (SELECT 0 UNION ALL "
      "SELECT i + 1 FROM n) SELECT 'none' AS table_name, i AS srs_id, 0 AS min_x, 0 AS min_y, 1 AS max_x, 1 AS max_y "
      "FROM n");
  expect_package_refused(path, "takes too long");
}

TEST(GeoPackage, ATileTableWithoutEndIsGivenUpOnce) {
  const ScratchFolder folder;
  const fs::path path = folder / "endless.gpkg";
  write_geopackage(path, {});
  run_sql(path,
          "DROP TABLE tiles; CREATE VIEW tiles AS WITH RECURSIVE n(i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM n) "
          "SELECT i AS id, min(i, 1) AS zoom_level, -1 - i AS tile_column, 0 AS tile_row, x'01' AS tile_data FROM n");
  const auto source = open(path);
  ASSERT_TRUE(source);
  EXPECT_NE(source->read({1, 0, 0}).error().why.find("takes too long"), std::string::npos);
  EXPECT_NE(source->read({1, 1, 0}).error().why.find("given up"), std::string::npos);
}

TEST(GeoPackage, SeveralThreadsRead) {
  const ScratchFolder folder;
  write_geopackage(folder / "a.gpkg", {});
  const auto source = open(folder / "a.gpkg");
  ASSERT_TRUE(source);
  std::vector<std::jthread> readers;
  for (int reader = 0; reader < 4; ++reader) {
    readers.emplace_back([&] {
      for (int i = 0; i < 100; ++i) EXPECT_TRUE(source->read({1, i % 4, i / 4 % 2}));
    });
  }
}

}  // namespace
}  // namespace terrella
