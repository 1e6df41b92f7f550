#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "apps/bench/benches.h"

namespace terrella::bench {

/// One row of `bench growth`: the cost of a subject at a size.
struct GrowthRow {
  std::string series;   ///< quantity that grows: "depth", "window", "layers", "workers", "cache"
  std::string subject;  ///< a view, or an operation of a cache
  double size = 0.0;    ///< level, pixels, layers, threads, tiles
  double ms = kNoFigure, cpu_ms = kNoFigure;
  double selection_ms = kNoFigure;
  std::int64_t patches = 0, tiles = 0;
  bool of_one = false;           ///< times are of one item, and should hardly grow
  double megabytes = kNoFigure;  ///< texture slots of a view; file of a cache
};

using AddRow = std::function<void(const GrowthRow& row)>;

/// Frames of sets of different depth, of windows of different size, and of 1 to 16 layers; and tiles that each sleep in
/// place of decoding, by 1 to 16 threads, which needs no cores. Needs a current OpenGL
/// context. Throws std::runtime_error. thread: main
void measure_view_growth(const BenchOptions& options, const AddRow& add);
/// Caches of 10^3 to 10^6 tiles (10^7 with Effort::full), whose rows are written without a network: open, look-up,
/// evict, `info`, `merge`, and a view drawn from them. The same conditions.
void measure_cache_growth(const BenchOptions& options, const AddRow& add);

}  // namespace terrella::bench
