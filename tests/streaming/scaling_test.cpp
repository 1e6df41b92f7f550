// Work that is spread over threads, counted: no test here looks at a clock.
#include <gtest/gtest.h>

#include <condition_variable>
#include <limits>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "streaming/raster/in_parallel.h"
#include "streaming_test_support.h"
#include "tiles/tile_loader.h"

namespace terrella {
namespace {

constexpr auto kMeetingPatience = std::chrono::seconds(30);  // a loaded machine under a sanitizer
constexpr int kRounds = 6;

/// Holds each piece of work until as many are under way as there are threads. Only that many threads at once can come
/// through, and each then has the same number of pieces.
class Meeting {
 public:
  explicit Meeting(int threads) : threads_(threads) {}

  void work() {
    std::unique_lock lock(mutex_);
    ++pieces_[std::this_thread::get_id()];
    const int round = begun_++ / threads_;
    changed_.notify_all();
    all_came_ =
        changed_.wait_for(lock, kMeetingPatience, [&] { return begun_ >= (round + 1) * threads_; }) && all_came_;
  }
  void expect_even() const {
    EXPECT_TRUE(all_came_) << "fewer than " << threads_ << " threads work at once";
    EXPECT_EQ(pieces_.size(), static_cast<std::size_t>(threads_));
    for (const auto& [thread, pieces] : pieces_) EXPECT_EQ(pieces, kRounds);
  }

 private:
  const int threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::thread::id, int> pieces_;
  int begun_ = 0;
  bool all_came_ = true;
};

/// Tiles whose pictures are made at a meeting, as resampled tiles are.
class MeetingSource : public TileSource {
 public:
  explicit MeetingSource(int threads) : meeting(threads) { info_.grid.max_level = 10; }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId&) override {
    return EncodedTile{.bytes = {}, .make_picture = [this]() -> Result<Image, TileFailure> {
                         meeting.work();
                         return TileFailure{MissingKind::blank, "no picture"};
                       }};
  }

  Meeting meeting;

 private:
  TileSetInfo info_;
};

class Scaling : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, Scaling, testing::Values(1, 2, 3, 8, 16));

TEST_P(Scaling, EachDecoderThreadHasItsShareOfTiles) {
  const auto source = std::make_shared<MeetingSource>(GetParam());
  TileLoader loader(source, {.workers = GetParam()});
  std::vector<TileRequest> wanted;
  for (int x = 0; x < kRounds * GetParam(); ++x) wanted.push_back({{10, x, 0}, 0.0});
  loader.request(wanted);
  const auto late = std::chrono::steady_clock::now() + 10 * kMeetingPatience;
  while (loader.wait(late)) static_cast<void>(loader.poll(std::numeric_limits<std::size_t>::max()));
  EXPECT_EQ(loader.counts().read, wanted.size());
  source->meeting.expect_even();
}

TEST_P(Scaling, EachThreadOfARasterHasItsShareOfBlocks) {
  Meeting meeting(GetParam());
  in_parallel(GetParam(), std::int64_t{kRounds} * GetParam(), [&](std::int64_t) { meeting.work(); });
  meeting.expect_even();
}

TEST(DecoderThreads, AreOneForEachCoreWithinBounds) {
  EXPECT_EQ(decoder_threads(0), 2) << "unknown";
  EXPECT_EQ(decoder_threads(1), 2);
  EXPECT_EQ(decoder_threads(6), 6);
  EXPECT_EQ(decoder_threads(128), 8);
}

}  // namespace
}  // namespace terrella
