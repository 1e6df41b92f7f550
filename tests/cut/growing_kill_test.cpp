// A process that cuts behind a window is killed: each tile that it has told to be finished is there for the next run.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <unordered_map>

#include "cut_files.h"
#include "streaming/cut/growing/growing_cut.h"
#include "streaming/cut/output/record_log.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

/// Finest tiles of 2560 × 1280 pixels: 80 × 40 of 32 pixels, in five bands.
constexpr std::size_t kTiles = 3200;
constexpr std::size_t kUntilKill = 1000;

/// A tile and its size, as the cutting process tells them.
struct ToldTile {
  TileId id;
  std::size_t bytes = 0;
};

/// Cuts and tells each finest tile as soon as it can be read. Runs in a process of its own, which never returns.
[[noreturn]] void cut_and_tell(const CutOptions& options, const fs::path& folder, int pipe) {
  const auto cut = GrowingCut::start(options, folder);
  if (!cut) _exit(1);
  const TileGrid& grid = (*cut)->info().grid;
  std::vector<TileId> missing;
  for (std::int64_t y = 0; y < rows(grid, grid.max_level); ++y) {
    for (std::int64_t x = 0; x < columns(grid, grid.max_level); ++x) {
      missing.push_back({.level = grid.max_level, .x = x, .y = y});
    }
  }
  while (!missing.empty()) {
    std::erase_if(missing, [&](const TileId& id) {
      const auto tile = (*cut)->read(id);
      if (!tile || tile->bytes.empty()) return false;
      const ToldTile told{.id = id, .bytes = tile->bytes.size()};
      return write(pipe, &told, sizeof(told)) == sizeof(told);
    });
  }
  _exit(0);
}

/// Finished tiles in the folder of an unfinished cut, with their sizes, as the next run finds them.
std::unordered_map<TileId, std::size_t, TileIdHash> tiles_left_in(const fs::path& work) {
  std::unordered_map<TileId, std::size_t, TileIdHash> found;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(work)) files.push_back(entry.path());
  for (fs::path log : files) {
    if (log.extension() == ".tiles") fs::rename(log, log.string() + ".part");
    if (log.extension() == ".part") log.replace_extension();
    if (log.extension() != ".tiles") continue;
    const auto keep = [&](const TileId& id, std::uint64_t, std::size_t bytes) { found[id] = bytes; };
    EXPECT_TRUE(RecordLogWriter::open(log, true, work, keep));
  }
  return found;
}

TEST(GrowingKillTest, LosesNoTileThatWasFinished) {
  const ScratchFolder folder;
  const CutOptions options{.images = {folder / "in.png"}, .tile_px = 32, .name = "in"};
  write_png(options.images.front(), noise(2560, 1280));
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t cutter = fork();
  ASSERT_GE(cutter, 0);
  if (cutter == 0) cut_and_tell(options, folder.path(), ends[1]);
  close(ends[1]);
  std::vector<ToldTile> told;
  for (ToldTile tile; read(ends[0], &tile, sizeof(tile)) == sizeof(tile);) {
    told.push_back(tile);
    if (told.size() == kUntilKill) kill(cutter, SIGKILL);
  }
  close(ends[0]);
  ASSERT_EQ(waitpid(cutter, nullptr, 0), cutter);
  ASSERT_GE(told.size(), kUntilKill);
  ASSERT_LT(told.size(), kTiles) << "it was killed halfway";

  std::vector<std::string> works = folder.names();
  std::erase_if(works, [](const std::string& name) { return !name.starts_with(".") || !name.ends_with(".part"); });
  ASSERT_EQ(works.size(), 1U);
  auto found = tiles_left_in(folder / works.front());
  for (const ToldTile& tile : told) {
    ASSERT_EQ(found[tile.id], tile.bytes) << tile.id.level << "/" << tile.id.x << "/" << tile.id.y;
  }
}

}  // namespace
}  // namespace terrella::test
