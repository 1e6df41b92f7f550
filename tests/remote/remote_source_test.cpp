// A source on the network whose cache is slow: the network goes on, and so do other tiles.
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "http_test_support.h"
#include "streaming/http/reply_queue.h"
#include "streaming/remote/remote_source.h"

namespace terrella::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr seconds kSlow{2};
constexpr int kTiles = 20;

/// Keeps nothing. A call about a tile of column 0 sleeps, as on a disk that spins up.
class SleepingCache : public TileCache {
 public:
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] std::filesystem::path set_aside() const override { return {}; }
  [[nodiscard]] Result<std::optional<CacheRecord>> find(const TileId& id) override {
    sleep(id);
    return std::optional<CacheRecord>();
  }
  [[nodiscard]] Result<std::optional<CacheRecord>> peek(const TileId&) override { return std::optional<CacheRecord>(); }
  void store(const TileId& id, CacheRecord, std::function<void(const StoreStatus&)>) override { sleep(id); }
  void renew(const TileId& id, std::int64_t, std::optional<std::int64_t>,
             std::function<void(const StoreStatus&)>) override {
    sleep(id);
  }
  void pin(const TileId&, std::int64_t, bool) override {}
  [[nodiscard]] Status flush() override { return Done{}; }
  [[nodiscard]] CacheCounts counts() const override { return {}; }

  [[nodiscard]] bool wait_until_asleep() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [this] { return asleep_; });
  }

 private:
  void sleep(const TileId& id) {
    if (id.x != 0) return;
    {
      const std::lock_guard lock(mutex_);
      asleep_ = true;
      changed_.notify_all();
    }
    std::this_thread::sleep_for(kSlow);
  }

  TileSetInfo info_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool asleep_ = false;
};

/// Answers as they come.
class Answers {
 public:
  [[nodiscard]] RemoteTiles::Done done(const TileId& id) {
    return [this, id](const Result<EncodedTile, TileFailure>&) {
      const std::lock_guard lock(mutex_);
      ++columns_[id.x];
      changed_.notify_all();
    };
  }
  [[nodiscard]] bool wait_for(std::size_t tiles) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [&] { return columns_.size() >= tiles; });
  }
  [[nodiscard]] std::map<std::int64_t, int> columns() {
    const std::lock_guard lock(mutex_);
    return columns_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::int64_t, int> columns_;
};

RemoteTileSet set_on(const MisbehavingServer& server, const std::string& fault) {
  RemoteTileSet set;
  set.info.grid.tile_px = 1;  // the picture that the server sends
  set.info.grid.max_level = 10;
  set.url = server.url("/" + fault + "/{z}/{x}/{y}");
  return set;
}

class SlowCache : public ::testing::TestWithParam<const char*> {};

// "ok" ends in store(), 404 in find() and store(), 500 in find().
TEST_P(SlowCache, DoesNotHoldUpTheAnswersToOtherTiles) {
  const MisbehavingServer server;
  const auto cache = std::make_shared<SleepingCache>();
  Answers answers;
  const auto source = make_remote_source(set_on(server, GetParam()), cache, quick_options());
  source->remote()->fetch({10, 0, 0}, 1.0, answers.done({10, 0, 0}));
  ASSERT_TRUE(cache->wait_until_asleep());
  const auto asleep = steady_clock::now();
  for (int x = 1; x < kTiles; ++x) source->remote()->fetch({10, x, 0}, 1.0, answers.done({10, x, 0}));
  ASSERT_TRUE(answers.wait_for(kTiles - 1));
  EXPECT_LT(steady_clock::now() - asleep, kSlow);
  EXPECT_FALSE(answers.columns().contains(0));
  ASSERT_TRUE(answers.wait_for(kTiles));
  for (const auto& [x, times] : answers.columns()) EXPECT_EQ(times, 1) << x;
}

INSTANTIATE_TEST_SUITE_P(Replies, SlowCache, ::testing::Values("ok", "404", "500"));

TEST(RemoteSource, TileThatIsCancelledWhileTheCacheSleepsIsNotAnswered) {
  const MisbehavingServer server;
  const auto cache = std::make_shared<SleepingCache>();
  Answers answers;
  {
    const auto source = make_remote_source(set_on(server, "ok"), cache, quick_options());
    source->remote()->fetch({10, 0, 0}, 1.0, answers.done({10, 0, 0}));
    ASSERT_TRUE(cache->wait_until_asleep());
    source->remote()->cancel({10, 0, 0});
  }
  EXPECT_TRUE(answers.columns().empty());
}

// By design: the network thread has nothing to call. Nobody takes these replies, and all requests are sent.
TEST(RemoteSource, NetworkGoesOnIfNobodyTakesItsReplies) {
  const MisbehavingServer server;
  ReplyQueue replies;
  HttpOptions options = quick_options();
  options.in_flight_per_host = 2;
  HttpFetcher fetcher(options, replies);
  for (int i = 1; i <= kTiles; ++i) {
    HttpRequest request;
    request.id = static_cast<std::uint64_t>(i);
    request.url = server.url("/ok/" + std::to_string(i));
    fetcher.submit(std::move(request));
  }
  const auto deadline = steady_clock::now() + kPatience;
  while (fetcher.counts().waiting + fetcher.counts().in_flight > 0 && steady_clock::now() < deadline) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_EQ(fetcher.counts().requests, static_cast<std::size_t>(kTiles));
  EXPECT_EQ(replies.take_all(milliseconds(0)).size(), static_cast<std::size_t>(kTiles));
}

}  // namespace
}  // namespace terrella::test
