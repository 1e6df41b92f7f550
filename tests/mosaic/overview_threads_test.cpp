// The threads that make a mosaic's coarse tiles: exceptions, and an answer that ends the mosaic.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <future>
#include <new>

#include "streaming/mosaic/overview.h"
#include "tests/mosaic/cells.h"
#include "tests/support/end_by_answer.h"

namespace terrella::test {
namespace {

using Encoded = Result<EncodedTile, TileFailure>;

Encoded fetched(RemoteTiles& tiles, const TileId& id) {
  std::promise<Encoded> made;
  tiles.fetch(id, 1.0, [&made](Encoded answer) { made.set_value(std::move(answer)); });
  return made.get_future().get();
}

TEST(OverviewThreads, ATileThatFindsNoMemoryFailsAndTheNextIsMade) {
  const TileId first{.level = 0, .x = 0, .y = 0}, next{.level = 0, .x = 1, .y = 0};
  Overview overview({.tile_px = 16,
                     .numbers = true,
                     .store = nullptr,
                     .begin = [] {},
                     .look = [](const TileId&) { return OverviewTile{.is_direct = true}; },
                     .make_direct = [&](const TileId& id) -> Encoded {
                       if (id == first) throw std::bad_alloc();
                       EncodedTile tile;
                       tile.make_numbers = []() -> Result<Numbers, TileFailure> {
                         return Numbers{16, 16, std::vector<float>(256, 7.0F)};
                       };
                       return tile;
                     }});
  const Encoded failed = fetched(overview.remote(), first);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, MissingKind::failed);
  EXPECT_EQ(failed.error().why, "not enough memory");
  EXPECT_TRUE(fetched(overview.remote(), next));
}

TEST(OverviewThreads, AnAnswerMayEndTheMosaic) {
  const ScratchFolder folder;
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 8; ++column) {
      write_cell(folder / fmt::format("cell-{}-{}.tif", row, column),
                 {.west_deg = 10.0 + column, .north_deg = 50.0 - row}, [](int x, int y) { return x + y; });
    }
  }
  std::shared_ptr<MosaicTiles> tiles = must_open(folder.path(), {.tile_px = 16});
  const TileXY at = tile_xy(tiles->info().grid, 0, 46.0, 14.0);
  const TileId coarsest{.level = 0, .x = static_cast<std::int64_t>(at.x), .y = static_cast<std::int64_t>(at.y)};
  const auto tile = tiles->read(coarsest);
  ASSERT_FALSE(tile);
  ASSERT_EQ(tile.error().kind, MissingKind::remote);
  EXPECT_TRUE(end_by_answer(std::move(tiles), coarsest));
}

}  // namespace
}  // namespace terrella::test
