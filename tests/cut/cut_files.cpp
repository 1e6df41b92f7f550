#include "cut_files.h"

#include <gtest/gtest.h>

#include "streaming/sets/open_tile_set.h"

namespace terrella::test {

Image part_of(const Image& image, int x0, int y0, int width, int height) {
  return painted(width, height, [&](int x, int y, int c) {
    return image.rgba[static_cast<std::size_t>(((y0 + y) * image.width_px + x0 + x) * 4 + c)];
  });
}

std::map<TileId, std::vector<std::byte>> all_tiles(const std::filesystem::path& tile_set) {
  std::map<TileId, std::vector<std::byte>> tiles;
  const auto source = open_stored_tile_set(tile_set, false);
  EXPECT_TRUE(source) << source.error().message;
  if (!source) return tiles;
  const TileGrid& grid = (*source)->info().grid;
  for (int level = 0; level <= grid.max_level; ++level) {
    for (std::int64_t y = 0; y < rows(grid, level); ++y) {
      for (std::int64_t x = 0; x < columns(grid, level); ++x) {
        auto tile = (*source)->read({level, x, y});
        if (tile) tiles[{level, x, y}] = std::move(tile->bytes);
      }
    }
  }
  EXPECT_FALSE(tiles.empty());
  return tiles;
}

bool must_cut(const CutOptions& options) {
  const auto made = cut(options);
  EXPECT_TRUE(made) << made.error().message;
  return made.ok();
}

void expect_refused(const CutOptions& options, const std::vector<std::string>& parts) {
  const auto made = cut(options);
  ASSERT_FALSE(made);
  for (const std::string& part : parts) {
    EXPECT_NE(made.error().message.find(part), std::string::npos) << part << " in: " << made.error().message;
  }
}

}  // namespace terrella::test
