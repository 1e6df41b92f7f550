// Tiles of blocks behind a network: exceptions, and an answer that ends the source.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <future>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "streaming/warp/warp_source.h"
#include "tests/support/end_by_answer.h"

namespace terrella::test {
namespace {

using Encoded = Result<EncodedTile, TileFailure>;
constexpr std::chrono::seconds kLongest{60};  // a loaded machine under a sanitizer

WarpOptions figure(double flattening) {
  return {.figure = {.ellipsoid = Ellipsoid(6378137.0, flattening)}, .body = {}, .tile_px = 64};
}

EncodedTile gray_block() {
  EncodedTile tile;
  tile.make_picture = []() -> Result<Image, TileFailure> {
    return Image{64, 64, std::vector<std::uint8_t>(64 * 64 * 4, 200)};
  };
  return tile;
}

/// A planet of blocks that have to be fetched; a thread of its own answers when the test says so.
class FarBlocks : public RasterSource, public RemoteTiles {
 public:
  FarBlocks() {
    info_.crs = "+proj=longlat +R=6378137 +type=crs";
    info_.levels = {{.width_px = 720,
                     .height_px = 360,
                     .block_width_px = 64,
                     .block_height_px = 64,
                     .to_crs = {-180.0, 0.5, 0.0, 90.0, 0.0, -0.5}}};
  }
  [[nodiscard]] const RasterInfo& info() const override { return info_; }
  [[nodiscard]] Encoded read(const TileId& id) override {
    if (throws) throw std::bad_alloc();
    bool is_kept = false;
    {
      const std::lock_guard lock(mutex_);
      is_kept = kept_.contains(id);
    }
    if (on_read) on_read(id);
    if (is_kept) return gray_block();
    return TileFailure{MissingKind::remote, {}};
  }
  [[nodiscard]] RemoteTiles* remote() override { return this; }
  void fetch(const TileId& id, double, Done done) override {
    if (refuses) throw std::runtime_error("no more threads");
    const std::lock_guard lock(mutex_);
    asked_[id] = std::move(done);
    ++requests_[id];
    changed_.notify_all();
  }
  void set_priority(const TileId&, double) override {}
  void cancel(const TileId& id) override {
    const std::lock_guard lock(mutex_);
    asked_.erase(id);
  }
  /// Answers what is asked, and keeps it as a cache does. False if nothing is asked for a moment.
  bool answer() {
    std::map<TileId, Done> asked;
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, std::chrono::milliseconds(10), [this] { return !asked_.empty(); });
      asked.swap(asked_);
      for (const auto& [id, done] : asked) kept_.insert(id);
    }
    for (const auto& [id, done] : asked) done(gray_block());
    return !asked.empty();
  }
  /// Does so for one block. False if it is not asked for.
  bool answer(const TileId& id) {
    Done done;
    {
      const std::lock_guard lock(mutex_);
      const auto asked = asked_.extract(id);
      if (asked.empty()) return false;
      done = asked.mapped();
      kept_.insert(id);
    }
    done(gray_block());
    return true;
  }
  [[nodiscard]] std::map<TileId, int> requests() {
    const std::lock_guard lock(mutex_);
    return requests_;
  }

  std::function<void(const TileId&)> on_read;  ///< called at the end of read(); set it while no tile is wished for
  std::atomic<bool> throws = false, refuses = false;

 private:
  RasterInfo info_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<TileId, Done> asked_;
  std::map<TileId, int> requests_;
  std::set<TileId> kept_;
};

struct FarRaster : testing::Test {
  FarRaster() {
    auto raster = std::make_unique<FarBlocks>();
    network = raster.get();
    tiles = *warp_source(std::move(raster), figure(0.0), "far");
    id = {.level = tiles->info().grid.max_level, .x = 3, .y = 2};
  }
  /// The answer to a fetch; failed if the call or the answer throws.
  [[nodiscard]] std::future<Encoded> fetch() {
    const auto answer = std::make_shared<std::promise<Encoded>>();
    auto came = answer->get_future();
    try {
      tiles->remote()->fetch(id, 1.0, [answer](Encoded tile) { answer->set_value(std::move(tile)); });
    } catch (const std::exception& error) {
      answer->set_value(TileFailure{MissingKind::absent, std::string("thrown: ") + error.what()});
    }
    return came;
  }
  /// False if the end of the source waits for something that does not come.
  [[nodiscard]] bool ends() {
    const auto ended = std::make_shared<std::promise<void>>();
    std::thread([source = std::move(tiles), ended]() mutable {
      source.reset();
      ended->set_value();
    }).detach();
    return ended->get_future().wait_for(kLongest) == std::future_status::ready;
  }
  void expect_failed(std::future<Encoded> answer, const std::string& why) {
    ASSERT_EQ(answer.wait_for(kLongest), std::future_status::ready);
    const Encoded tile = answer.get();
    ASSERT_FALSE(tile);
    EXPECT_EQ(tile.error().kind, MissingKind::failed);
    EXPECT_NE(tile.error().why.find(why), std::string::npos) << tile.error().why;
  }

  FarBlocks* network = nullptr;
  std::unique_ptr<TileSource> tiles;
  TileId id;
};

TEST_F(FarRaster, ALookUpThatThrowsFailsTheTileAndTheSourceEnds) {
  network->throws = true;
  expect_failed(fetch(), "not enough memory");
  EXPECT_TRUE(ends());
}

TEST_F(FarRaster, ABlockThatCannotBeAskedForFailsTheTileAndTheNextOneComes) {
  network->refuses = true;
  expect_failed(fetch(), "no more threads");
  network->refuses = false;
  auto next = fetch();
  while (next.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) network->answer();
  EXPECT_TRUE(next.get());
  EXPECT_TRUE(ends());
}

/// The parent of a tile looks for the blocks of the tile, and each comes just after it was looked for and not found:
/// some at the first look, some at a later one.
TEST_F(FarRaster, BlocksThatComeDuringALookAreRequestedOnce) {
  std::map<TileId, int> looks;
  std::atomic<bool> is_second = false;
  bool one_came = false;
  std::promise<void> came;
  network->on_read = [&](const TileId& block) {
    if (!is_second) return;
    const int look = ++looks[block];
    if (look == 1 && !one_came) one_came = network->answer(block);
    if (look != 2) return;
    for (const auto& [asked, times] : network->requests()) network->answer(asked);
    is_second = false;
    came.set_value();
  };
  id = {.level = id.level - 1, .x = 1, .y = 1};
  auto first_tile = fetch();
  while (network->requests().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  is_second = true;
  id = {.level = id.level - 1, .x = 0, .y = 0};
  auto second_tile = fetch();
  ASSERT_EQ(came.get_future().wait_for(kLongest), std::future_status::ready);
  for (auto* tile : {&first_tile, &second_tile}) {
    while (tile->wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) network->answer();
    EXPECT_TRUE(tile->get());
  }
  EXPECT_TRUE(one_came);
  for (const auto& [block, times] : network->requests()) EXPECT_EQ(times, 1) << block.x << ' ' << block.y;
  EXPECT_TRUE(ends());
}

TEST_F(FarRaster, AnAnswerMayEndTheSource) {
  std::thread answering([this] {
    while (!network->answer()) continue;  // the answers end the network too
  });
  EXPECT_TRUE(end_by_answer(std::shared_ptr<TileSource>(std::move(tiles)), id));
  answering.join();
}

}  // namespace
}  // namespace terrella::test
