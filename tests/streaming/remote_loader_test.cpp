// The loader over a source whose tiles have to be fetched: nothing waits in a worker, and late answers hurt nobody.
#include <gtest/gtest.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "streaming_test_support.h"
#include "tiles/tile_loader.h"

namespace terrella {
namespace {

constexpr auto kRemotePatience = std::chrono::seconds(30);  // a loaded machine under a sanitizer
constexpr int kRemotePx = 16;

/// Has nothing at hand; the test plays the network.
class FarSource : public TileSource, public RemoteTiles {
 public:
  FarSource() : tile_(*encode_png(test::gradient(kRemotePx, kRemotePx))) {
    info_.grid.tile_px = kRemotePx;
    info_.grid.max_level = 10;
  }

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId&) override {
    return TileFailure{MissingKind::remote, {}};
  }
  [[nodiscard]] RemoteTiles* remote() override { return this; }

  void fetch(const TileId& id, double priority, Done done) override {
    const std::lock_guard lock(mutex_);
    asked_.insert_or_assign(id.x, Asked{priority, std::move(done)});
    changed_.notify_all();
  }
  void set_priority(const TileId& id, double priority) override {
    const std::lock_guard lock(mutex_);
    if (const auto asked = asked_.find(id.x); asked != asked_.end()) asked->second.priority = priority;
  }
  void cancel(const TileId& id) override {
    const std::lock_guard lock(mutex_);
    if (auto asked = asked_.extract(id.x); !asked.empty()) late_.push_back(std::move(asked.mapped().done));
  }

  [[nodiscard]] bool wait_until_asked(std::size_t tiles) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kRemotePatience, [&] { return asked_.size() >= tiles; });
  }
  [[nodiscard]] std::map<std::int64_t, double> asked() {
    const std::lock_guard lock(mutex_);
    std::map<std::int64_t, double> priorities;
    for (const auto& [x, asked] : asked_) priorities[x] = asked.priority;
    return priorities;
  }
  /// Every tile comes, from a thread of its own, and with them the answers to what was cancelled.
  void answer() {
    std::vector<Done> all;
    {
      const std::lock_guard lock(mutex_);
      all.swap(late_);
      for (auto& [x, asked] : asked_) all.push_back(std::move(asked.done));
      asked_.clear();
    }
    std::thread([&] {
      for (const Done& done : all) done(EncodedTile{tile_});
    }).join();
  }

 private:
  struct Asked {
    double priority;
    Done done;
  };
  TileSetInfo info_;
  std::vector<std::byte> tile_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::int64_t, Asked> asked_;
  std::vector<Done> late_;
};

std::vector<TileRequest> wishes(int first, int last) {
  std::vector<TileRequest> list;
  for (int x = first; x <= last; ++x) list.push_back({{6, x, 0}, static_cast<double>(x)});
  return list;
}

std::size_t poll_all(TileLoader& loader) {
  std::size_t tiles = 0;
  while (loader.wait(std::chrono::steady_clock::now() + kRemotePatience)) {
    for (const LoadedTile& tile : loader.poll(1)) tiles += tile.tile ? 1 : 0;
  }
  return tiles;
}

TEST(RemoteLoader, OneWorkerAsksForAllBeforeOneHasCome) {
  const auto source = std::make_shared<FarSource>();
  TileLoader loader(source, {.workers = 1});
  loader.request(wishes(1, 50));
  ASSERT_TRUE(source->wait_until_asked(50));
  EXPECT_EQ(loader.counts().fetching, 50U);
  source->answer();
  EXPECT_EQ(poll_all(loader), 50U);
  EXPECT_EQ(loader.counts().fetching, 0U);
}

TEST(RemoteLoader, PrioritiesFollowTheViewAndWhatItLeftIsCancelled) {
  const auto source = std::make_shared<FarSource>();
  TileLoader loader(source);
  loader.request(wishes(1, 20));
  ASSERT_TRUE(source->wait_until_asked(20));
  std::vector<TileRequest> next = wishes(11, 20);
  for (TileRequest& wish : next) wish.priority += 100.0;
  loader.request(next);
  const auto asked = source->asked();
  ASSERT_EQ(asked.size(), 10U);
  for (const auto& [x, priority] : asked) EXPECT_EQ(priority, static_cast<double>(x) + 100.0);
  source->answer();
  EXPECT_EQ(poll_all(loader), 10U) << "an answer to what was cancelled is dropped";
}

TEST(RemoteLoader, WhatIsUnderWayIsNotAskedForTwice) {
  const auto source = std::make_shared<FarSource>();
  TileLoader loader(source);
  for (int frame = 0; frame < 20; ++frame) loader.request(wishes(1, 5));
  ASSERT_TRUE(source->wait_until_asked(5));
  loader.request(wishes(1, 5));
  EXPECT_EQ(loader.counts().waiting, 0U);
  source->answer();
  EXPECT_EQ(poll_all(loader), 5U);
}

/// Throws when the network is asked.
class ThrowingNetwork : public FarSource {
 public:
  void fetch(const TileId&, double, Done) override { throw 5; }
};

TEST(RemoteLoader, AnExceptionOfTheNetworkIsAFailedTile) {
  TileLoader loader(std::make_shared<ThrowingNetwork>());
  loader.request(wishes(1, 2));
  std::size_t failed = 0;
  while (loader.wait(std::chrono::steady_clock::now() + kRemotePatience)) {
    for (const LoadedTile& tile : loader.poll(std::size_t{1} << 30)) {
      EXPECT_EQ(tile.tile ? MissingKind::absent : tile.tile.error().kind, MissingKind::failed);
      ++failed;
    }
  }
  EXPECT_GT(failed, 0U);
}

TEST(RemoteLoader, AnswersAfterItsEndAreDropped) {
  const auto source = std::make_shared<FarSource>();
  {
    TileLoader loader(source);
    loader.request(wishes(1, 20));
    ASSERT_TRUE(source->wait_until_asked(20));
  }
  EXPECT_TRUE(source->asked().empty()) << "what was under way is cancelled";
  source->answer();
}

}  // namespace
}  // namespace terrella
