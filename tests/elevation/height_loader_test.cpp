#include "tiles/height_loader.h"

#include <gtest/gtest.h>

#include <map>

#include "../streaming/streaming_test_support.h"
#include "elevation_files.h"
#include "streaming/cut.h"

namespace terrella::test {
namespace {

using std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::seconds(30);  // a loaded machine under a sanitizer

/// A planet of 4 × 2 tiles of 16 pixels, cut by the cutter.
class HeightLoaderTest : public testing::Test {
 protected:
  void SetUp() override {
    write_raster(folder_ / "in.png", raster_, "UInt16");
    const auto made = cut({.images = {folder_ / "in.png"},
                           .output = folder_ / "set.gpkg",
                           .tile_px = 16,
                           .format = {},
                           .elevation = CutElevation{.scale = 0.5, .offset = -8.0},
                           .bounds = {},
                           .name = {},
                           .attribution = {},
                           .body = {},
                           .progress = {}});
    ASSERT_TRUE(made) << made.error().message;
  }

  [[nodiscard]] std::vector<TileRequest> all_tiles() const {
    std::vector<TileRequest> wanted;
    for (std::int64_t i = 0; i < 8; ++i) wanted.push_back({{.level = 1, .x = i % 4, .y = i / 4}, 1.0});
    return wanted;
  }

  ScratchFolder folder_;
  const Raster raster_ = random_raster(64, 32, 0, 60000);
};

std::map<TileId, LoadedHeights> drain(HeightLoader& loader, std::size_t max_bytes) {
  std::map<TileId, LoadedHeights> all;
  const auto deadline = steady_clock::now() + kPatience;
  while (loader.wait(deadline)) {
    for (LoadedHeights& tile : loader.poll(max_bytes)) {
      EXPECT_TRUE(all.emplace(tile.id, std::move(tile)).second) << "loaded twice";
    }
  }
  EXPECT_LT(steady_clock::now(), deadline);
  return all;
}

TEST_F(HeightLoaderTest, GivesTheHeightsOfWhatIsAskedForOnce) {
  const auto source = must_open(folder_ / "set.gpkg");
  ASSERT_TRUE(source);
  HeightLoader loader(*source, {.workers = 2});
  loader.request(all_tiles());
  loader.request(all_tiles());
  const auto tiles = drain(loader, 1);
  ASSERT_EQ(tiles.size(), 8U);
  for (const auto& [id, loaded] : tiles) {
    ASSERT_TRUE(loaded.tile) << loaded.tile.error().why;
    EXPECT_EQ(loaded.tile->id, id);
    for (int i = 0; i < 16 * 16; ++i) {
      const double number = raster_.at(id.x * 16 + i % 16, id.y * 16 + i / 16);
      EXPECT_EQ(loaded.tile->heights_m[static_cast<std::size_t>(i)], static_cast<float>(number * 0.5 - 8.0));
    }
  }
  EXPECT_EQ(loader.counts().read, 8U);
  EXPECT_EQ(loader.counts().missing, 0U);
}

TEST_F(HeightLoaderTest, FailuresAreTypedAsThoseOfPictures) {
  run_sql(folder_ / "set.gpkg",
          "UPDATE tiles SET tile_data = X'00' WHERE zoom_level = 1 AND tile_column = 1 AND tile_row = 0;"
          "UPDATE tiles SET tile_data = X'' WHERE zoom_level = 1 AND tile_column = 2 AND tile_row = 0;"
          "DELETE FROM tiles WHERE zoom_level = 1 AND tile_column = 3 AND tile_row = 0");
  const auto source = must_open(folder_ / "set.gpkg");
  ASSERT_TRUE(source);
  HeightLoader loader(*source);
  loader.request(all_tiles());
  const auto tiles = drain(loader, 1U << 20);
  ASSERT_EQ(tiles.size(), 8U);
  const std::map<std::int64_t, MissingKind> expected = {
      {1, MissingKind::broken}, {2, MissingKind::blank}, {3, MissingKind::absent}};
  for (const auto& [x, kind] : expected) {
    const auto& tile = tiles.at({.level = 1, .x = x, .y = 0});
    ASSERT_FALSE(tile.tile);
    EXPECT_EQ(tile.tile.error().kind, kind) << x;
  }
  EXPECT_EQ(loader.counts().missing, 3U);
}

TEST_F(HeightLoaderTest, WorkersPauseOverTheBoundAndPollsAreBounded) {
  const auto source = must_open(folder_ / "set.gpkg");
  ASSERT_TRUE(source);
  constexpr std::size_t kTileBytes = 16 * 16 * sizeof(float);
  HeightLoader loader(*source, {.workers = 1, .max_finished_bytes = 2 * kTileBytes});
  loader.request(all_tiles());
  const auto deadline = steady_clock::now() + kPatience;
  while (loader.counts().finished < 2 && steady_clock::now() < deadline) loader.wait(deadline);
  EXPECT_EQ(loader.poll(0).size(), 1U) << "at least one";
  EXPECT_EQ(drain(loader, 2 * kTileBytes).size(), 7U);
}

}  // namespace
}  // namespace terrella::test
