#pragma once

#include <chrono>

#include "apps/bench/benches.h"
#include "geo/camera.h"

namespace terrella::bench {

/// The size of the pictures that bench_objects() draws.
inline Viewport object_picture(Effort effort) {
  return effort == Effort::quick ? Viewport{192, 192} : Viewport{1024, 1024};
}
/// Objects that have not settled within this are a failure.
inline constexpr std::chrono::seconds kLongestSettling{300};

/// Times frames with lines and areas on the ground as ratios to the bare globe of the same view, and edits of them.
/// Appends to the report of bench_objects(). Throws std::runtime_error. thread: that of the current OpenGL context
void bench_ground(const BenchOptions& options, Report& report);

}  // namespace terrella::bench
