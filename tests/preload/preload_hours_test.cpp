#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <set>

#include "streaming/http/reply_queue.h"
#include "streaming/preload/preloader.h"
#include "tests/preload/plan_support.h"
#include "tests/support/scratch_folder.h"

namespace terrella {
namespace {

/// An origin that has no tile, and answers when it is told to.
class SlowOrigin : public TileOrigin {
 public:
  SlowOrigin(ReplyQueue& answers, std::set<TileId>& asked, const bool& open)
      : answers_(answers), asked_(asked), open_(open) {}
  void ask(TileQuestion question) override {
    EXPECT_TRUE(open_) << "asks outside of the hours";
    waiting_.push_back(std::move(question));
  }
  void withdraw(std::uint64_t number) override {
    std::erase_if(waiting_, [number](const TileQuestion& one) { return one.number == number; });
  }
  /// Answers some of the oldest questions.
  void answer(int most) {
    for (; most > 0 && !waiting_.empty(); --most) {
      HttpReply reply;
      reply.id = waiting_.front().number;
      reply.outcome = HttpOutcome::nothing;
      asked_.insert(waiting_.front().id);
      waiting_.pop_front();
      answers_.push(std::move(reply));
    }
  }
  [[nodiscard]] HttpCounts counts() const override {
    HttpCounts counts;
    counts.waiting = waiting_.size();
    return counts;
  }

 private:
  ReplyQueue& answers_;
  std::set<TileId>& asked_;
  const bool& open_;
  std::deque<TileQuestion> waiting_;
};

TEST(PreloadHours, NothingIsAskedOutsideOfThemAndAllIsAskedAfterwards) {
  test::ScratchFolder folder;
  TileSetInfo info;
  info.name = "hours";
  info.grid.max_level = 4;
  auto cache = TileCache::open(folder.path() / "hours.gpkg", info, "hours");
  ASSERT_TRUE(cache) << cache.error().message;
  const auto plan = plan_region(info.grid, Ellipsoid(6378137.0, 0.0), {}, 0, 4);
  std::set<TileId> asked;
  bool open = false;
  int looks = 0;
  SlowOrigin* origin = nullptr;
  PreloadOptions options;
  options.set.info = info;
  options.window = 16;
  options.closed_for = [&] {
    open = ++looks > 3 && looks % 10 < 7;  // the clock of the test
    if (open) origin->answer(10);
    return std::chrono::seconds(open ? 0 : 3600);
  };
  const auto make = [&](ReplyQueue& answers) {
    auto made = std::make_unique<SlowOrigin>(answers, asked, open);
    origin = made.get();
    return made;
  };
  const auto result = preload(*plan, **cache, make, options);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->end, PreloadEnd::complete);
  EXPECT_EQ(result->counts.absent, plan->total());
  EXPECT_EQ(asked, test::set_of(*plan));
  EXPECT_GT(looks, 20);
}

TEST(PreloadHours, WithNothingToRequestItDoesNotWait) {
  test::ScratchFolder folder;
  TileSetInfo info;
  info.name = "hours";
  info.grid.max_level = 4;
  auto cache = TileCache::open(folder.path() / "hours.gpkg", info, "hours");
  ASSERT_TRUE(cache);
  const auto plan = plan_region(info.grid, Ellipsoid(6378137.0, 0.0), {}, 0, 4);
  std::set<TileId> asked;
  bool open = true;
  SlowOrigin* origin = nullptr;
  PreloadOptions options;
  options.set.info = info;
  options.closed_for = [&] {
    origin->answer(1000);
    return std::chrono::seconds(open ? 0 : 3600);
  };
  int reports = 0;
  std::chrono::seconds waits{0};
  options.progress = [&](const PreloadCounts& counts) {
    waits = std::max(waits, counts.waits);
    return ++reports < 50;
  };
  const auto make = [&](ReplyQueue& answers) {
    auto made = std::make_unique<SlowOrigin>(answers, asked, open);
    origin = made.get();
    return made;
  };
  ASSERT_TRUE(preload(*plan, **cache, make, options));
  open = false;
  asked.clear();
  const auto again = preload(*plan, **cache, make, options);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->end, PreloadEnd::complete);
  EXPECT_EQ(again->counts.there, plan->total());
  EXPECT_TRUE(asked.empty());
  EXPECT_EQ(waits, std::chrono::seconds(0));
}

TEST(PreloadHours, AStopIsHeardWhileItWaits) {
  test::ScratchFolder folder;
  TileSetInfo info;
  info.name = "hours";
  auto cache = TileCache::open(folder.path() / "hours.gpkg", info, "hours");
  ASSERT_TRUE(cache);
  const auto plan = plan_region(info.grid, Ellipsoid(6378137.0, 0.0), {}, 0, 0);
  std::set<TileId> asked;
  const bool open = false;
  int reports = 0;
  PreloadOptions options;
  options.set.info = info;
  options.closed_for = [] { return std::chrono::seconds(3600); };
  std::chrono::seconds waits{0};
  options.progress = [&](const PreloadCounts& counts) {
    waits = std::max(waits, counts.waits);
    return ++reports < 3;
  };
  const auto result = preload(
      *plan, **cache, [&](ReplyQueue& answers) { return std::make_unique<SlowOrigin>(answers, asked, open); }, options);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->end, PreloadEnd::stopped);
  EXPECT_TRUE(asked.empty());
  EXPECT_EQ(waits, std::chrono::hours(1));
}

}  // namespace
}  // namespace terrella
