#pragma once

#include <filesystem>

#include "apps/bench/benches.h"
#include "apps/bench/truth/truth_cache.h"
#include "base/result.h"

// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.

namespace terrella::bench {

/// A planet to measure on: its picture, and the PNG tiles cut from it.
struct TestPlanet {
  truth::Source source;
  std::filesystem::path tiles;
};

/// The noise planet (truth/noise_planet.h): 8192×4096 as paper 1's picture, or
/// 1024×512 for a quick run. Created and cut on first use.
[[nodiscard]] Result<TestPlanet> noise_test_planet(const BenchOptions& options);

/// Like noise_test_planet(), but with one file per tile in a folder.
[[nodiscard]] Result<TestPlanet> noise_test_folder(const BenchOptions& options);

/// Folder of cached ground-truth pictures, about 27 MB each.
[[nodiscard]] std::filesystem::path truth_folder(const BenchOptions& options);

}  // namespace terrella::bench
