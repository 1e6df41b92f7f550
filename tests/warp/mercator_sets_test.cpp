// Sets in Web Mercator as they lie on disk: found to be such, drawn as geodetic ones, kept as they are.
#include <gtest/gtest.h>

#include <cmath>

#include "mercator_planet.h"
#include "streaming/cache/tile_cache.h"
#include "streaming/sets/open_tile_set.h"
#include "tests/streaming/streaming_test_support.h"
#include "tests/support/scratch_folder.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using test::PlaceColor;
using test::ScratchFolder;

constexpr int kSquarePx = 32;
constexpr int kSquareLevel = 3;

/// Red goes with longitude, green with latitude: four levels of colour a pixel of the finest tiles at least.
PlaceColor place_color(double lat, double lon) {
  return {.red = 127.5 + lon / 180.0 * 120.0, .green = 127.5 + lat / 90.0 * 120.0, .blue = 60.0};
}

std::vector<std::byte> square_tile(int level, std::int64_t x, std::int64_t y) {
  return *encode_png(test::mercator_tile(place_color, kSquarePx, level, x, y));
}

/// Calls for each tile of the levels: level, column, row from the north.
template <class Call>
void for_square(int first_level, const Call& call) {
  for (int level = first_level; level <= kSquareLevel; ++level) {
    for (int x = 0; x < 1 << level; ++x) {
      for (int y = 0; y < 1 << level; ++y) call(level, x, y);
    }
  }
}

void write_folder(const fs::path& root, bool from_south) {
  for_square(0, [&](int level, int x, int y) {
    const fs::path column = root / std::to_string(level) / std::to_string(x);
    fs::create_directories(column);
    const int row = from_south ? (1 << level) - 1 - y : y;
    test::write_bytes(column / (std::to_string(row) + ".png"), square_tile(level, x, y));
  });
}

void write_square_mbtiles(const fs::path& file, const std::string& metadata) {
  test::run_sql(file,
                "CREATE TABLE tiles (zoom_level INTEGER, tile_column INTEGER, tile_row INTEGER, tile_data BLOB); "
                "CREATE TABLE metadata (name TEXT, value TEXT); " +
                    metadata);
  for_square(0, [&](int level, int x, int y) {
    test::insert_tile(file, level, x, (1 << level) - 1 - y, square_tile(level, x, y));
  });
}

/// The set is made of Web Mercator, and its tiles show the colours of their places.
void expect_square(const fs::path& path, bool geodetic = false) {
  SCOPED_TRACE(path.string());
  const auto tiles = open_tile_set(path, geodetic);
  ASSERT_TRUE(tiles) << tiles.error().message;
  const TileSetInfo& info = (*tiles)->info();
  ASSERT_TRUE(info.made_of);
  EXPECT_EQ(info.made_of->projection, Projection::web_mercator);
  EXPECT_EQ(info.grid.projection, Projection::equirectangular);
  EXPECT_EQ(info.grid.root_span_deg, 360.0);
  const TileId id{3, 5, 1};
  const auto tile = (*tiles)->read(id);
  ASSERT_TRUE(tile) << tile.error().why;
  const auto picture = tile->make_picture();
  ASSERT_TRUE(picture) << picture.error().why;
  const TileBounds bounds = tile_bounds(info.grid, id);
  const double step = tile_span_deg(info.grid, 3) / kSquarePx;
  for (int j = 3; j < kSquarePx; j += 7) {
    for (int i = 0; i < kSquarePx; ++i) {
      const PlaceColor color = place_color(bounds.north_deg - (j + 0.5) * step, bounds.west_deg + (i + 0.5) * step);
      const std::uint8_t* pixel = picture->rgba.data() + static_cast<std::size_t>(j * kSquarePx + i) * 4;
      ASSERT_NEAR(pixel[0], color.red, 1.0) << i << " " << j;
      ASSERT_NEAR(pixel[1], color.green, 1.0) << i << " " << j;
    }
  }
}

std::string error_on_opening(const fs::path& path) {
  const auto tiles = open_tile_set(path);
  return tiles ? "" : tiles.error().message;
}

TEST(MercatorSets, AFolderWhoseDescriptionSaysIt) {
  const ScratchFolder folder;
  write_folder(folder / "xyz", false);
  test::write_text(folder / "xyz/tileset.json",
                   R"({"projection": "web-mercator", "tile_px": 32, "max_level": 3, "format": "png"})");
  expect_square(folder / "xyz");
  test::write_text(
      folder / "xyz/tileset.json",
      R"({"projection": "web-mercator", "root_span_deg": 180.5, "tile_px": 32, "max_level": 3, "format": "png"})");
  EXPECT_NE(error_on_opening(folder / "xyz").find("360 or a half"), std::string::npos);
  test::write_text(folder / "xyz/tileset.json",
                   R"({"projection": "web-mercator", "tile_px": 2048, "max_level": 3, "format": "png"})");
  EXPECT_NE(error_on_opening(folder / "xyz").find("at most 1024 in Web Mercator"), std::string::npos);
}

TEST(MercatorSets, TheFolderOfATms) {
  const ScratchFolder folder;
  write_folder(folder / "tms", true);
  std::string xml = R"(<TileMap version="1.0.0"><Title>t</Title><SRS>EPSG:3857</SRS>
    <BoundingBox minx="-180.0" miny="-85.05" maxx="180.0" maxy="85.05"/>
    <TileFormat width="32" height="32" mime-type="image/png" extension="png"/><TileSets profile="mercator">)";
  for (int level = 0; level <= kSquareLevel; ++level) {
    xml += "<TileSet href=\"" + std::to_string(level) + "\" units-per-pixel=\"" +
           std::to_string(std::ldexp(40075016.68557849 / kSquarePx, -level)) + "\" order=\"0\"/>";
  }
  test::write_text(folder / "tms/tilemapresource.xml", xml + "</TileSets></TileMap>");
  expect_square(folder / "tms");
}

TEST(MercatorSets, MbtilesThatSayNothingOrSayIt) {
  const ScratchFolder folder;
  write_square_mbtiles(folder / "silent.mbtiles", "");
  expect_square(folder / "silent.mbtiles");
  write_square_mbtiles(folder / "web.mbtiles", "INSERT INTO metadata VALUES ('crs', 'EPSG:3857')");
  expect_square(folder / "web.mbtiles");
}

TEST(MercatorSets, MbtilesWhoseTilesDoNotGoWithThat) {
  const ScratchFolder folder;
  for (const bool wide : {true, false}) {
    // Geodetic ones that do not say so: two root tiles, or one whose rows end half way.
    const fs::path file = folder / (wide ? "wide.mbtiles" : "flat.mbtiles");
    test::run_sql(file,
                  "CREATE TABLE tiles (zoom_level INTEGER, tile_column INTEGER, tile_row INTEGER, tile_data BLOB); "
                  "CREATE TABLE metadata (name TEXT, value TEXT);");
    for (int x = 0; x < (wide ? 4 : 2); ++x) test::insert_tile(file, 1, x, 0, square_tile(1, 0, 0));
    const std::string message = error_on_opening(file);
    EXPECT_NE(message.find("‹projection› equirectangular"), std::string::npos) << message;
    EXPECT_TRUE(open_tile_set(file, true));
  }
}

TEST(MercatorSets, ACacheKeepsTheStoredTilesAndIsOpenedAsAnyGeoPackage) {
  const ScratchFolder folder;
  TileSetInfo info;
  info.grid = {
      .root_span_deg = 360.0, .tile_px = kSquarePx, .max_level = kSquareLevel, .projection = Projection::web_mercator};
  info.format = ImageFormat::png;
  const fs::path file = folder / "cache.gpkg";
  {
    const auto cache = TileCache::open(file, info, "the test");
    ASSERT_TRUE(cache) << cache.error().message;
    for_square(0, [&](int level, int x, int y) {
      CacheRecord record;
      record.bytes = square_tile(level, x, y);
      (*cache)->store({level, x, y}, std::move(record));
    });
    ASSERT_TRUE((*cache)->flush());
  }
  expect_square(file);
  // As a file of another program, with EPSG:3857 alone to go by.
  test::run_sql(file, "DROP TABLE terrella_tileset");
  expect_square(file);
  test::run_sql(file, "UPDATE gpkg_tile_matrix_set SET max_y = max_y - 1000000, min_y = min_y - 1000000");
  EXPECT_NE(error_on_opening(file).find("GoogleMapsCompatible"), std::string::npos) << error_on_opening(file);
}

}  // namespace
}  // namespace terrella
