#include <gtest/gtest.h>

#include <filesystem>

#include "streaming/sets/open_tile_set.h"
#include "streaming/sets/tileset_json.h"
#include "streaming_test_support.h"
#include "tiles/tile_range.h"
#include "tiles/tile_source.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using test::ScratchFolder;

std::string error_of(const fs::path& path) {
  const auto source = open_tile_set(path);
  EXPECT_FALSE(source);
  return source ? "" : source.error().message;
}

void expect_says(const std::string& message, std::initializer_list<std::string> parts) {
  for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

/// Two levels of 180° with the tile 1/3/1 missing, 1/0/0 empty and 1/1/0 broken.
void write_set(const fs::path& root) {
  TileSetInfo info;
  info.name = "places";
  info.grid.tile_px = 32;
  info.grid.max_level = 1;
  info.format = ImageFormat::png;
  test::write_text(root / kTileSetFile, to_tileset_json(info));
  for (int level = 0; level <= 1; ++level) {
    for_each_place(info.grid, level, [&](const TileId& id) {
      const fs::path path = root / std::to_string(id.level) / std::to_string(id.x) / (std::to_string(id.y) + ".png");
      test::write_bytes(path, *encode_png(test::place_tile(info.grid, id)));
      return true;
    });
  }
  fs::remove(root / "1/3/1.png");
  test::write_text(root / "1/0/0.png", "");
  test::write_text(root / "1/1/0.png", "<html>");
}

TEST(Directory, OurOwnSetIsRead) {
  const ScratchFolder folder;
  write_set(folder / "set");
  const auto source = open_tile_set(folder / "set");
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->info().name, "places");
  const TileGrid& grid = (*source)->info().grid;
  constexpr double kRounding = 0.51;  // rounding of colours to 8 bits
  EXPECT_LE(test::worst_misplacement(grid, {0, 1, 0}, test::load_tile(**source, {0, 1, 0})), kRounding);
  EXPECT_LE(test::worst_misplacement(grid, {1, 2, 1}, test::load_tile(**source, {1, 2, 1})), kRounding);
  EXPECT_EQ((*source)->count_tiles(0), 2);
  EXPECT_EQ((*source)->count_tiles(1), 7);
  EXPECT_EQ((*source)->count_tiles(2), 0);
}

TEST(Directory, MissingIsTyped) {
  const ScratchFolder folder;
  write_set(folder / "set");
  const auto source = open_tile_set(folder / "set");
  ASSERT_TRUE(source) << source.error().message;
  const auto kind = [&](const TileId& id) { return (*source)->read(id).error().kind; };
  EXPECT_EQ(kind({1, 3, 1}), MissingKind::absent);
  EXPECT_EQ(kind({1, 0, 0}), MissingKind::blank);
  for (const TileId& outside : {TileId{2, 0, 0}, TileId{-1, 0, 0}, TileId{0, 2, 0}, TileId{0, -1, 0}, TileId{0, 0, 1},
                                TileId{1, 1LL << 60, 0}, TileId{1 << 30, 0, 0}}) {
    EXPECT_EQ(kind(outside), MissingKind::absent);
  }
  fs::remove(folder / "set/1/1/0.png");
  fs::create_directory(folder / "set/1/1/0.png");
  EXPECT_EQ(kind({1, 1, 0}), MissingKind::failed);
}

TEST(Directory, NaturalEarthCountsItsRowsFromTheSouth) {
  const auto source = open_tile_set(fs::path(TERRELLA_FIXTURES) / "natural_earth_ii");
  ASSERT_TRUE(source) << source.error().message;
  const TileGrid& grid = (*source)->info().grid;
  EXPECT_EQ(grid, (TileGrid{.root_span_deg = 180.0, .tile_px = 256, .min_level = 0, .max_level = 2}));
  EXPECT_EQ((*source)->count_tiles(2), 32);
  // Antarctica is white and the Arctic Ocean is blue: the mean of the outermost rows tells north from south.
  const auto red_of_row = [&](std::int64_t y, int row_px) {
    double sum = 0.0;
    for (std::int64_t x = 0; x < 4; ++x) {
      const Image tile = test::load_tile(**source, {1, x, y});
      for (int i = 0; i < 256; ++i) sum += tile.rgba[static_cast<std::size_t>(row_px * 256 + i) * 4];
    }
    return sum / (4 * 256);
  };
  EXPECT_LT(red_of_row(0, 0) + 50.0, red_of_row(1, 255));
}

TEST(OpenTileSet, SaysWhatWouldBeAccepted) {
  const ScratchFolder folder;
  expect_says(error_of(folder / "nowhere"), {"nowhere", "no such file"});
  fs::create_directory(folder / "empty");
  expect_says(error_of(folder / "empty"), {"the directory is empty", "tileset.json", "tilemapresource.xml", "‹cut›"});
  test::write_text(folder / "notes/readme.txt", "hello");
  expect_says(error_of(folder / "notes"), {"holds no tileset.json", "tilemapresource.xml"});
  expect_says(error_of(folder / "notes/readme.txt"), {"readme.txt", "neither a picture nor a tile set", "GeoPackage"});
  test::write_text(folder / "zero.gpkg", "");
  expect_says(error_of(folder / "zero.gpkg"), {"zero.gpkg", "empty"});
}

TEST(OpenTileSet, ADescriptionWithoutTilesIsRefused) {
  const ScratchFolder folder;
  write_set(folder / "set");
  fs::remove_all(folder / "set/0");
  fs::remove_all(folder / "set/1");
  expect_says(error_of(folder / "set"), {"levels 0 to 1", "no folder \"0\""});
}

TEST(OpenTileSet, NamesTheFileAndFieldOfABadDescription) {
  const ScratchFolder folder;
  test::write_text(folder / "set/tileset.json", "{\"root_span_deg\": 180}");
  expect_says(error_of(folder / "set"), {"set/tileset.json", "tile_px", "missing"});
  test::write_text(folder / "tms/tilemapresource.xml", "<TileMap><SRS>EPSG:31467</SRS></TileMap>");
  expect_says(error_of(folder / "tms"), {"tms/tilemapresource.xml", "TileFormat", "width"});
}

}  // namespace
}  // namespace terrella
