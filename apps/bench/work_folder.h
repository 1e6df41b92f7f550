#pragma once

#include <filesystem>

#include "apps/bench/benches.h"
#include "apps/bench/truth/truth_cache.h"
#include "base/result.h"

namespace terrella::bench {

/// A planet to measure on: its picture, and the PNG tiles that `cut` makes of it.
struct TestPlanet {
  truth::Source source;
  std::filesystem::path tiles;
};

/// The noise planet (truth/noise_planet.h), 8192×4096 as paper 1's picture, 1024×512 for a quick run; made and cut the
/// first time.
[[nodiscard]] Result<TestPlanet> noise_test_planet(const BenchOptions& options);

/// The same with its tiles in a folder, a file each.
[[nodiscard]] Result<TestPlanet> noise_test_folder(const BenchOptions& options);

/// Where the ground truth's pictures are remembered: about 27 MB each.
[[nodiscard]] std::filesystem::path truth_folder(const BenchOptions& options);

}  // namespace terrella::bench
