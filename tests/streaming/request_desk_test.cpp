// Wishes, cancels and threads of a source: each rule of RequestDesk.
#include "tiles/request_desk.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace terrella {
namespace {

using Answer = RequestDesk::Answer;
constexpr std::chrono::seconds kDeskPatience{60};  // a loaded machine under a sanitizer

TileId tile(std::int64_t x) { return {.level = 10, .x = x, .y = 0}; }

/// A door that is shut at first. Work waits before it.
class Door {
 public:
  void open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void pass() {
    std::unique_lock lock(mutex_);
    ++waiting_;
    changed_.notify_all();
    EXPECT_TRUE(changed_.wait_for(lock, kDeskPatience, [this] { return open_; }));
  }
  void wait_for_visitors(int visitors) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, kDeskPatience, [&] { return waiting_ >= visitors; }));
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
  int waiting_ = 0;
};

/// Events in their order.
class Notes {
 public:
  void add(std::int64_t x) {
    const std::lock_guard lock(mutex_);
    notes_.push_back(x);
    changed_.notify_all();
  }
  [[nodiscard]] std::vector<std::int64_t> wait_for(std::size_t size) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, kDeskPatience, [&] { return notes_.size() >= size; }));
    return notes_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::int64_t> notes_;
};

RemoteTiles::Done noted(Notes& notes, std::int64_t x) {
  return [&notes, x](const Answer&) { notes.add(x); };
}

TEST(RequestDesk, TheMostWantedComesFirstByItsNewestPriority) {
  Door door;
  Notes answers;
  RequestDesk desk({.work = [&](const TileWish& wish) -> Answer {
                      if (wish.id == tile(0)) door.pass();
                      return EncodedTile{};
                    },
                    .threads = 1});
  desk.fetch(tile(0), 0.0, noted(answers, 0));
  door.wait_for_visitors(1);
  for (int x = 1; x <= 3; ++x) desk.fetch(tile(x), x, noted(answers, x));
  desk.set_priority(tile(1), 7.0);
  door.open();
  EXPECT_EQ(answers.wait_for(4), (std::vector<std::int64_t>{0, 1, 3, 2}));
}

TEST(RequestDesk, AnExceptionFailsItsTileAlone) {
  RequestDesk desk({.work = [](const TileWish& wish) -> Answer {
    if (wish.id == tile(1)) throw std::runtime_error("it is broken");
    if (wish.id == tile(2)) throw 7;
    return EncodedTile{};
  }});
  const auto answer = [&](std::int64_t x) {
    std::promise<Answer> came;
    desk.fetch(tile(x), 0.0, [&](Answer one) { came.set_value(std::move(one)); });
    return came.get_future().get();
  };
  EXPECT_EQ(answer(1).error().kind, MissingKind::failed);
  EXPECT_EQ(answer(1).error().why, "it is broken");
  EXPECT_EQ(answer(2).error().kind, MissingKind::failed);
  EXPECT_TRUE(answer(3));
}

TEST(RequestDesk, ACancelledWishIsNotAnsweredAndEndsAfterItsWork) {
  Door door;
  Notes answers, ends;
  RequestDesk desk({.work = [&](const TileWish& wish) -> Answer {
                      door.pass();
                      return TileFailure{MissingKind::failed, desk.is_wanted(wish.number) ? "" : "given up"};
                    },
                    .ended = [&](const TileWish& wish, bool is_answered) { ends.add(is_answered ? 0 : wish.id.x); },
                    .threads = 1});
  desk.fetch(tile(1), 0.0, noted(answers, 1));
  door.wait_for_visitors(1);
  desk.fetch(tile(2), 0.0, noted(answers, 2));
  desk.cancel(tile(2));
  EXPECT_EQ(ends.wait_for(1), std::vector<std::int64_t>{2}) << "nobody worked on it";
  desk.cancel(tile(1));
  desk.cancel(tile(5));
  desk.fetch(tile(1), 0.0, noted(answers, 3));  // the same tile again
  EXPECT_EQ(ends.wait_for(0).size(), 1U) << "the first wish is still in work";
  door.open();
  EXPECT_EQ(answers.wait_for(1), std::vector<std::int64_t>{3});
  EXPECT_EQ(ends.wait_for(3), (std::vector<std::int64_t>{2, 1, 0}));
}

TEST(RequestDesk, AWishWaitsUntilItIsResumedAlsoDuringItsWork) {
  Door door;
  Notes answers, visits;
  RequestDesk desk({.work = [&](const TileWish& wish) -> std::optional<Answer> {
    visits.add(wish.is_new ? 1 : 2);
    if (!wish.is_new) return EncodedTile{};
    if (wish.id == tile(1)) door.pass();
    return std::nullopt;
  }});
  desk.fetch(tile(1), 0.0, noted(answers, 1));
  door.wait_for_visitors(1);
  desk.resume(tile(1));
  door.open();
  EXPECT_EQ(answers.wait_for(1), std::vector<std::int64_t>{1});
  desk.fetch(tile(2), 0.0, noted(answers, 2));
  EXPECT_EQ(visits.wait_for(3).size(), 3U);
  desk.resume(tile(3));  // nobody wants it
  desk.resume_all();
  EXPECT_EQ(answers.wait_for(2).back(), 2);
  EXPECT_EQ(visits.wait_for(4), (std::vector<std::int64_t>{1, 2, 1, 2}));
}

TEST(RequestDesk, FewerThreadsBeginThanGoOn) {
  Door door;
  Notes answers;
  RequestDesk desk({.work = [&](const TileWish& wish) -> std::optional<Answer> {
                      if (wish.id == tile(1)) door.pass();
                      return wish.is_new && wish.id == tile(0) ? std::nullopt : std::optional<Answer>(EncodedTile{});
                    },
                    .beginners = 1});
  desk.fetch(tile(0), 0.0, noted(answers, 0));
  desk.fetch(tile(1), 0.0, noted(answers, 1));
  door.wait_for_visitors(1);
  desk.fetch(tile(2), 9.0, noted(answers, 2));
  desk.resume(tile(0));
  EXPECT_EQ(answers.wait_for(1), std::vector<std::int64_t>{0}) << "the new wish waits for the one that begins";
  door.open();
  EXPECT_EQ(answers.wait_for(3).size(), 3U);
}

TEST(RequestDesk, AnAnswerMayEndTheDeskWhileAnotherThreadWorks) {
  Door in_work;
  RequestDesk* tiles = nullptr;
  auto desk = std::make_unique<RequestDesk>(RequestDesk::Parts{.work = [&](const TileWish& wish) -> Answer {
    if (wish.id == tile(2)) in_work.open();
    // Until the desk closes.
    while (wish.id == tile(2) && tiles->is_wanted(wish.number)) std::this_thread::yield();
    return EncodedTile{};
  }});
  tiles = desk.get();
  std::promise<void> ended;
  tiles->fetch(tile(2), 0.0, [](const Answer&) { ADD_FAILURE() << "its desk is gone"; });
  in_work.pass();
  tiles->fetch(tile(1), 0.0, [&](const Answer&) {
    desk.reset();
    ended.set_value();
  });
  EXPECT_EQ(ended.get_future().wait_for(kDeskPatience), std::future_status::ready);
}

}  // namespace
}  // namespace terrella
