// Sources of every kind are opened, asked for tiles by several threads, and ended at random moments in every way.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <future>
#include <optional>
#include <random>
#include <thread>

#include "tests/sources/source_kinds.h"
#include "tiles/tile_loader.h"

namespace terrella::test {
namespace {

constexpr unsigned kSourceSeed = 20261124;
constexpr int kOpens = 100;

/// Random moments and tiles, the same in each run.
class Chance {
 public:
  explicit Chance(unsigned seed) : engine_(seed) {}
  [[nodiscard]] int below(int end) { return static_cast<int>(engine_() % static_cast<unsigned>(end)); }
  void pause() { std::this_thread::sleep_for(std::chrono::microseconds(below(2000))); }
  [[nodiscard]] TileId tile(const TileGrid& grid) {
    for (;;) {
      const int level = grid.min_level + below(grid.max_level - grid.min_level + 1);
      const TileId id{.level = level,
                      .x = below(static_cast<int>(columns(grid, level))),
                      .y = below(static_cast<int>(rows(grid, level)))};
      if (exists(grid, id)) return id;
    }
  }

 private:
  std::minstd_rand engine_;
};

/// Calls the network side as no loader would: at any time, tiles that are not wanted any more too.
void ask(const std::shared_ptr<TileSource>& source, Chance chance) {
  const TileGrid grid = source->info().grid;
  RemoteTiles* const tiles = source->remote();
  for (int i = chance.below(40); i > 0; --i) {
    const TileId id = chance.tile(grid);
    tiles->fetch(id, chance.below(9), [](const auto&) {});
    if (chance.below(2) == 0) tiles->set_priority(id, chance.below(9));
    if (chance.below(2) == 0) tiles->cancel(id);
    if (chance.below(8) == 0) chance.pause();
  }
}

/// Wants other tiles a few times, as a camera that moves does.
void look(TileLoader& loader, const TileGrid& grid, Chance& chance) {
  for (int i = chance.below(4); i > 0; --i) {
    std::vector<TileRequest> wanted;
    for (int k = chance.below(12); k > 0; --k) wanted.push_back({chance.tile(grid), 1.0 * chance.below(9)});
    loader.request(wanted);
    chance.pause();
    static_cast<void>(loader.poll(1 << 20));
  }
}

/// An answer has the last owner. A late worker of the loader may want the same tile; the answer then goes uncalled.
void end_in_an_answer(std::shared_ptr<TileSource> source, const TileId& id) {
  const auto ended = std::make_shared<std::promise<void>>();
  RemoteTiles* const tiles = source->remote();
  std::shared_ptr<void> owner(nullptr, [source = std::move(source), ended](void*) mutable {
    source.reset();
    ended->set_value();
  });
  tiles->fetch(id, 9.0, [owner = std::move(owner)](const auto&) mutable { owner.reset(); });
  EXPECT_EQ(ended->get_future().wait_for(kPatience), std::future_status::ready);
}

void open_and_end(std::shared_ptr<TileSource> source, Chance& chance) {
  const TileGrid grid = source->info().grid;
  const Chance theirs(static_cast<unsigned>(chance.below(1 << 30)));
  std::optional<std::jthread> other;
  if (chance.below(2) == 0) other.emplace([source, theirs] { ask(source, theirs); });
  std::optional<TileLoader> loader;
  loader.emplace(source, LoaderOptions{.workers = 2});
  look(*loader, grid, chance);
  switch (chance.below(3)) {
    case 0:
      loader.reset();
      source.reset();
      break;
    case 1:
      source.reset();  // the loader, a worker or the other thread has the last owner
      loader.reset();
      break;
    default:
      loader.reset();
      other.reset();
      end_in_an_answer(std::move(source), chance.tile(grid));
  }
}

class SourceEnds : public testing::TestWithParam<std::string> {};

TEST_P(SourceEnds, AtAnyMoment) {
  std::printf("seed %u\n", kSourceSeed);
  SourceFiles files;
  Chance chance(kSourceSeed);
  for (int i = 0; i < kOpens && !HasFailure(); ++i) {
    auto source = files.open(GetParam());
    ASSERT_TRUE(source);
    open_and_end(std::move(source), chance);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SourceEnds, testing::ValuesIn(SourceFiles::kinds()),
                         [](const auto& kind) { return kind.param; });

}  // namespace
}  // namespace terrella::test
