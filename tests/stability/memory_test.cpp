// A flight that never comes to the same place twice holds no more after many legs than after a few.
#include <numeric>
#include <span>
#include <vector>

#include "memory_flight.h"
#include "tests/gl/gl_context_test.h"

namespace terrella::test {
namespace {

constexpr Viewport kSmall{64, 48};
constexpr int kLegs = 24, kFrames = 15;
// Memory of the last third of a flight may exceed that of the second third by 5 %: more would be a leak.
constexpr double kMostGrowth = 1.05;

class Memory : public GlContextTest {};

double mean_heap_mb(std::span<const MemorySample> samples) {
  return std::accumulate(samples.begin(), samples.end(), 0.0,
                         [](double sum, const MemorySample& sample) { return sum + sample.heap_mb; }) /
         static_cast<double>(samples.size());
}

TEST_F(Memory, AFlightHoldsNoMoreThanItsBudgetsAndNothingGrows) {
  // Limits for two image layers together; so small a picture never needs a third of them.
  constexpr std::size_t kMostPatches = 2 * 2048, kMostTiles = 2 * 8192;
  MemoryFlight flight(kSmall, kFrames, 7);
  std::vector<MemorySample> samples;
  for (int leg = 0; leg < kLegs; ++leg) {
    samples.push_back(flight.fly());
    const FrameStats& last = samples.back().last;
    EXPECT_LE(last.gpu_bytes, MemoryFlight::kGpuBytes);
    EXPECT_LE(last.height_bytes, MemoryFlight::kHeightBytes);
    EXPECT_LE(samples.back().most_held, kMostPatches);
    EXPECT_LE(samples.back().most_known, kMostTiles);
    EXPECT_TRUE(leg == 0 || samples.back().uncovered == 0);
  }
  // The first third fills what has room.
  const std::span all(samples);
  EXPECT_LE(mean_heap_mb(all.last(kLegs / 3)), kMostGrowth * mean_heap_mb(all.subspan(kLegs / 3, kLegs / 3)));
  // There was more than there is room for.
  EXPECT_GT(samples.back().most_held, kMostPatches * 3 / 4);
  EXPECT_GT(samples.back().last.height_bytes, MemoryFlight::kHeightBytes / 2);
}

}  // namespace
}  // namespace terrella::test
