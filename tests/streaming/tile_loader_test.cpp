#include "tiles/tile_loader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "streaming_test_support.h"

namespace terrella {
namespace {

using std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::seconds(30);  // a loaded machine under a sanitizer
constexpr int kTilePx = 16;
constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

/// Tiles made of nothing; a closed gate holds readers up, so that a test decides what a worker has begun and what not.
class GatedSource : public TileSource {
 public:
  GatedSource() : tile_(*encode_png(test::gradient(kTilePx, kTilePx))) {
    info_.grid.tile_px = kTilePx;
    info_.grid.max_level = 10;
  }

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    std::unique_lock lock(mutex_);
    order_.push_back(id);
    changed_.notify_all();
    changed_.wait(lock, [this] { return open_; });
    if (id.level == 9) throw std::runtime_error("thrown by the source");
    if (id.level == 7) throw 7;
    if (id.level == 6) return EncodedTile{.bytes = {}, .make_picture = []() -> Result<Image, TileFailure> { throw 6; }};
    if (id.level == 10) return TileFailure{MissingKind::absent, "not there"};
    return EncodedTile{id.level == 8 ? test::bytes_of("not a picture") : tile_};
  }

  void open(bool is_open = true) {
    const std::lock_guard lock(mutex_);
    open_ = is_open;
    changed_.notify_all();
  }
  void wait_until_begun(std::size_t reads) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, kPatience, [&] { return order_.size() >= reads; }));
  }
  [[nodiscard]] std::vector<TileId> order() {
    const std::lock_guard lock(mutex_);
    return order_;
  }

 private:
  TileSetInfo info_;
  std::vector<std::byte> tile_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
  std::vector<TileId> order_;
};

std::vector<TileRequest> wishes(std::initializer_list<std::pair<int, double>> columns) {
  std::vector<TileRequest> list;
  for (const auto& [x, priority] : columns) list.push_back({{5, x, 0}, priority});
  return list;
}

/// Polls until nothing is under way.
std::vector<LoadedTile> drain(TileLoader& loader) {
  std::vector<LoadedTile> all;
  const auto deadline = steady_clock::now() + kPatience;
  while (loader.wait(deadline)) {
    for (LoadedTile& tile : loader.poll(kAll)) all.push_back(std::move(tile));
  }
  EXPECT_LT(steady_clock::now(), deadline);
  return all;
}

TEST(TileLoader, LoadsWhatIsAskedFor) {
  const auto source = std::make_shared<GatedSource>();
  source->open();
  TileLoader loader(source, {.workers = 3, .gutter = 2, .mips = 2});
  loader.request(wishes({{1, 0.0}, {2, 0.0}, {3, 0.0}}));
  const auto tiles = drain(loader);
  std::set<TileId> ids;
  for (const LoadedTile& tile : tiles) {
    ids.insert(tile.id);
    ASSERT_TRUE(tile.tile) << tile.tile.error().why;
    EXPECT_EQ(tile.tile->mips.size(), 2U);
    EXPECT_EQ(tile.tile->gutter, 2);
  }
  EXPECT_EQ(ids, (std::set<TileId>{{5, 1, 0}, {5, 2, 0}, {5, 3, 0}}));
  EXPECT_EQ(loader.counts().read, 3U);
  EXPECT_EQ(loader.counts().missing, 0U);
}

TEST(TileLoader, ReadsInTheOrderOfTheLatestPriorities) {
  const auto source = std::make_shared<GatedSource>();
  TileLoader loader(source, {.workers = 1});
  loader.request(wishes({{0, 9.0}}));
  source->wait_until_begun(1);
  loader.request(wishes({{1, 1.0}, {2, 2.0}, {3, 3.0}, {4, std::nan("")}}));
  loader.request(wishes({{1, 7.0}, {2, 5.0}, {3, 6.0}, {4, std::nan("")}}));
  source->open();
  drain(loader);
  EXPECT_EQ(source->order(), (std::vector<TileId>{{5, 0, 0}, {5, 1, 0}, {5, 3, 0}, {5, 2, 0}, {5, 4, 0}}));
}

TEST(TileLoader, WhatIsNoLongerWantedIsCancelled) {
  const auto source = std::make_shared<GatedSource>();
  TileLoader loader(source, {.workers = 1});
  loader.request(wishes({{0, 9.0}, {1, 1.0}, {2, 2.0}}));
  source->wait_until_begun(1);
  EXPECT_EQ(loader.counts().waiting, 2U);
  EXPECT_EQ(loader.counts().running, 1U);
  loader.request(wishes({{2, 2.0}}));
  EXPECT_EQ(loader.counts().waiting, 1U);
  source->open();
  drain(loader);
  EXPECT_EQ(source->order(), (std::vector<TileId>{{5, 0, 0}, {5, 2, 0}}));
}

TEST(TileLoader, NothingIsReadTwice) {
  const auto source = std::make_shared<GatedSource>();
  TileLoader loader(source, {.workers = 1});
  loader.request(wishes({{0, 1.0}, {0, 2.0}}));
  source->wait_until_begun(1);
  loader.request(wishes({{0, 1.0}}));  // running
  source->open();
  ASSERT_TRUE(loader.wait(steady_clock::now() + kPatience));
  loader.request(wishes({{0, 1.0}}));  // finished
  EXPECT_EQ(loader.counts().waiting, 0U);
  EXPECT_EQ(loader.poll(kAll).size(), 1U);
  EXPECT_EQ(source->order().size(), 1U);
  loader.request(wishes({{0, 1.0}}));  // polled: read again
  EXPECT_EQ(drain(loader).size(), 1U);
  EXPECT_EQ(source->order().size(), 2U);
}

TEST(TileLoader, SaysWhyThereAreNoPixels) {
  const auto source = std::make_shared<GatedSource>();
  source->open();
  TileLoader loader(source);
  const std::vector<TileRequest> bad{{{8, 0, 0}, 0.0}, {{9, 0, 0}, 0.0}, {{10, 0, 0}, 0.0}};
  loader.request(bad);
  std::map<int, MissingKind> kinds;
  for (const LoadedTile& tile : drain(loader)) {
    ASSERT_FALSE(tile.tile);
    EXPECT_FALSE(tile.tile.error().why.empty());
    kinds[tile.id.level] = tile.tile.error().kind;
  }
  EXPECT_EQ(kinds, (std::map<int, MissingKind>{
                       {8, MissingKind::broken}, {9, MissingKind::failed}, {10, MissingKind::absent}}));
  EXPECT_EQ(loader.counts().missing, 3U);
}

TEST(TileLoader, AnExceptionOfAnyTypeIsAFailedTile) {
  const auto source = std::make_shared<GatedSource>();
  source->open();
  TileLoader loader(source);
  const std::vector<TileRequest> thrown_by_read_and_decode{{{7, 0, 0}, 0.0}, {{6, 0, 0}, 0.0}};
  loader.request(thrown_by_read_and_decode);
  const auto tiles = drain(loader);
  EXPECT_EQ(tiles.size(), 2U);
  for (const LoadedTile& tile : tiles) {
    ASSERT_FALSE(tile.tile);
    EXPECT_EQ(tile.tile.error().kind, MissingKind::failed);
    EXPECT_NE(tile.tile.error().why.find("threw"), std::string::npos);
  }
}

TEST(TileLoader, WorkersPauseOverTheBound) {
  const auto source = std::make_shared<GatedSource>();
  source->open();
  TileLoader loader(source, {.workers = 1, .max_finished_bytes = 1, .gutter = 0, .mips = 1});
  loader.request(wishes({{0, 3.0}, {1, 2.0}, {2, 1.0}}));
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(loader.wait(steady_clock::now() + kPatience));
    EXPECT_EQ(loader.counts().finished, 1U);
    EXPECT_EQ(loader.counts().waiting, static_cast<std::size_t>(2 - i));
    EXPECT_EQ(loader.poll(0).size(), 1U);
  }
  EXPECT_FALSE(loader.wait(steady_clock::now() + kPatience));
}

TEST(TileLoader, PollGivesAtMostTheBytesAskedForButOne) {
  const auto source = std::make_shared<GatedSource>();
  source->open();
  TileLoader loader(source, {.workers = 1, .gutter = 0, .mips = 1});
  constexpr std::size_t kTileBytes = kTilePx * kTilePx * 4;
  loader.request(wishes({{0, 5.0}, {1, 4.0}, {2, 3.0}, {3, 2.0}}));
  const auto deadline = steady_clock::now() + kPatience;
  while (loader.counts().finished < 4 && steady_clock::now() < deadline) std::this_thread::yield();
  EXPECT_EQ(loader.poll(0).size(), 1U);
  EXPECT_EQ(loader.poll(2 * kTileBytes).size(), 2U);
  EXPECT_EQ(loader.poll(2 * kTileBytes).size(), 1U);
  EXPECT_TRUE(loader.poll(kAll).empty());
}

TEST(TileLoader, WaitEndsWithTheDeadline) {
  const auto source = std::make_shared<GatedSource>();
  TileLoader loader(source, {.workers = 1});
  EXPECT_FALSE(loader.wait(steady_clock::now() + kPatience));  // nothing under way: at once
  loader.request(wishes({{0, 1.0}}));
  EXPECT_FALSE(loader.wait(steady_clock::now() + std::chrono::milliseconds(20)));
  source->open();
}

TEST(TileLoader, ShutsDownWhileBusy) {
  const auto source = std::make_shared<GatedSource>();
  std::jthread opener;
  {
    // The bound holds the workers back once the gate is open: what was waiting is dropped, what was running is
    // finished.
    TileLoader loader(source, {.workers = 2, .max_finished_bytes = 1});
    std::vector<TileRequest> many;
    for (int x = 0; x < 60; ++x) many.push_back({{5, x % 32, x / 32}, 0.0});
    loader.request(many);
    source->wait_until_begun(2);
    opener = std::jthread([source] {
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      source->open();
    });
  }
  EXPECT_EQ(source->order().size(), 2U);
}

TEST(TileLoader, ManyWorkersAndChangingWishes) {
  const auto source = std::make_shared<GatedSource>();
  source->open();
  TileLoader loader(source, {.workers = 8, .max_finished_bytes = 8 * kTilePx * kTilePx * 4});
  std::map<TileId, int> got;
  for (int round = 0; round < 50; ++round) {
    std::vector<TileRequest> list;
    for (int x = 0; x < 20; ++x) list.push_back({{5, (round + x) % 32, 0}, static_cast<double>((x * 7 + round) % 13)});
    loader.request(list);
    loader.wait(steady_clock::now() + std::chrono::milliseconds(1));
    for (const LoadedTile& tile : loader.poll(4 * kTilePx * kTilePx * 4)) ++got[tile.id];
  }
  for (const LoadedTile& tile : drain(loader)) ++got[tile.id];
  std::size_t sum = 0;
  for (const auto& [id, count] : got) sum += static_cast<std::size_t>(count);
  EXPECT_EQ(sum, source->order().size());
  EXPECT_EQ(loader.counts().read, sum);
}

}  // namespace
}  // namespace terrella
