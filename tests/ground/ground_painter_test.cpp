// The threads that paint pictures of the ground: faults, ends and many jobs.
#include "globe/ground_painter.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <new>
#include <thread>

namespace terrella {
namespace {

using namespace std::chrono_literals;

GroundJob job_at(std::uint32_t x) { return {.id = {CubeFace::pos_x, 6, x, 0}, .layers = {}, .revision = x}; }

std::deque<GroundJob> jobs(std::uint32_t count) {
  std::deque<GroundJob> all;
  for (std::uint32_t k = 0; k < count; ++k) all.push_back(job_at(k));
  return all;
}

/// Takes pictures until there are so many.
std::vector<PaintedGround> take(GroundPainter& painter, std::size_t count) {
  std::vector<PaintedGround> all;
  for (int k = 0; k < 10'000 && all.size() < count; ++k) {
    for (PaintedGround& one : painter.take()) all.push_back(std::move(one));
    std::this_thread::sleep_for(1ms);
  }
  return all;
}

TEST(GroundPainter, AJobWithoutMemoryIsToldAndItsThreadPaintsTheNext) {
  GroundPainter painter(std::make_shared<ArrivalBell>(), [](const GroundJob& job, const auto&, GroundCanvas&) {
    if (job.id.x % 2 == 0) throw std::bad_alloc();
    return GroundPicture{.fill = {job.id.x}, .lines = {}};
  });
  painter.ask(jobs(40));
  const auto all = take(painter, 40);
  ASSERT_EQ(all.size(), 40U);
  for (const PaintedGround& one : all) {
    EXPECT_EQ(one.is_painted, one.id.x % 2 == 1);
    EXPECT_EQ(one.picture.fill.empty() ? 0 : one.picture.fill[0], one.is_painted ? one.id.x : 0U);
    EXPECT_FALSE(painter.is_painting(one.id));
  }
}

// A globe may end at any time: the end does not wait for pictures, and these do not touch what has ended.
TEST(GroundPainter, EndsWhileItPaintsAndDoesNotWait) {
  for (int round = 0; round < 20; ++round) {
    auto begun = std::make_shared<std::atomic<int>>(0), ended = std::make_shared<std::atomic<int>>(0);
    auto may_end = std::make_shared<std::atomic<bool>>(false);
    {
      GroundPainter painter(std::make_shared<ArrivalBell>(),
                            [=](const GroundJob&, const std::atomic<bool>& stop, GroundCanvas&) {
                              ++*begun;
                              while (!stop || !*may_end) std::this_thread::sleep_for(1ms);
                              ++*ended;
                              return GroundPicture{};
                            });
      painter.ask(jobs(30));
      while (*begun == 0) std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(*ended, 0) << "the end has waited";
    *may_end = true;
    for (int k = 0; k < 10'000 && *ended < *begun; ++k) std::this_thread::sleep_for(1ms);
    EXPECT_EQ(*ended, *begun);
  }
}

TEST(GroundPainter, NewJobsReplaceThoseThatWaitButNotThoseBeingPainted) {
  std::atomic<bool> go = false;
  std::atomic<int> painted = 0;
  GroundPainter painter(std::make_shared<ArrivalBell>(), [&](const GroundJob&, const auto& stop, GroundCanvas&) {
    while (!go && !stop) std::this_thread::sleep_for(1ms);
    ++painted;
    return GroundPicture{};
  });
  painter.ask(jobs(60));
  while (!painter.is_painting(job_at(0).id)) std::this_thread::sleep_for(1ms);
  painter.ask({job_at(0), job_at(63)});  // 0 is not begun a second time
  go = true;
  int first = 0, last = 0;
  while (first == 0 || last == 0) {
    for (const PaintedGround& one : take(painter, 1)) {
      first += one.id == job_at(0).id ? 1 : 0;
      last += one.id == job_at(63).id ? 1 : 0;
    }
  }
  EXPECT_EQ(first, 1);
  EXPECT_EQ(last, 1);
  EXPECT_LE(painted, 10) << "at most eight threads had begun";
}

}  // namespace
}  // namespace terrella
