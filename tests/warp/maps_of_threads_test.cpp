// A planner whose further threads cannot open a map.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "geo/body.h"
#include "streaming/warp/warp_source.h"

namespace terrella::test {
namespace {

/// No file can be opened while it lives.
class NoMoreFiles {
 public:
  NoMoreFiles() {
    getrlimit(RLIMIT_NOFILE, &before_);
    rlimit none = before_;
    none.rlim_cur = 3;
    setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoMoreFiles() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoMoreFiles(const NoMoreFiles&) = delete;
  NoMoreFiles& operator=(const NoMoreFiles&) = delete;

 private:
  rlimit before_{};
};

/// A local gray raster in a system of PROJ's database.
class NearBlocks : public RasterSource {
 public:
  NearBlocks() {
    info_.crs = "EPSG:32633";
    info_.levels = {{.width_px = 640,
                     .height_px = 640,
                     .block_width_px = 64,
                     .block_height_px = 64,
                     .to_crs = {200000.0, 1000.0, 0.0, 5500000.0, 0.0, -1000.0}}};
  }
  [[nodiscard]] const RasterInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId&) override {
    EncodedTile tile;
    tile.make_picture = []() -> Result<Image, TileFailure> {
      return Image{64, 64, std::vector<std::uint8_t>(64 * 64 * 4, 200)};
    };
    return tile;
  }

 private:
  RasterInfo info_;
};

// Each thread that plans has a map of its own. PROJ opens its database for each.
TEST(MapsOfThreads, ATileWithoutAMapFailsAndIsNotTransparent) {
  const auto source = warp_source(std::make_unique<NearBlocks>(),
                                  {.figure = {.ellipsoid = earth().ellipsoid}, .body = {}, .tile_px = 64}, "near");
  ASSERT_TRUE(source) << source.error().message;
  TileSource& tiles = **source;
  const TileGrid& grid = tiles.info().grid;
  const TileXY at = tile_xy(grid, grid.max_level, 47.0, 14.0);
  const TileId id{.level = grid.max_level, .x = static_cast<std::int64_t>(at.x), .y = static_cast<std::int64_t>(at.y)};
  std::atomic<int> failed = 0, clear = 0, other = 0;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  const auto read = [&] {
    while (failed == 0 && clear == 0 && std::chrono::steady_clock::now() < deadline) {
      const auto tile = tiles.read(id);
      if (!tile) ++(tile.error().kind == MissingKind::failed ? failed : other);
      const auto image = tile ? tile->make_picture() : Result<Image, TileFailure>(TileFailure{});
      if (image && image->rgba[(64 * 32 + 32) * 4 + 3] == 0) ++clear;
    }
  };
  {
    const NoMoreFiles none;
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i) threads.emplace_back(read);
  }
  EXPECT_EQ(clear, 0);
  EXPECT_EQ(other, 0);
  EXPECT_GT(failed, 0);
  EXPECT_TRUE(tiles.read(id)) << "later it can be read";
}

}  // namespace
}  // namespace terrella::test
