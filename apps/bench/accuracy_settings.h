#pragma once

#include <string>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/truth/ray_caster.h"
#include "geo/cube_sphere.h"
#include "globe/globe.h"
#include "surface/plan/patch_selection.h"

// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.

namespace terrella::bench {

/// One value of one option of a globe; all other options have their defaults.
struct AccuracySetting {
  const char* sweep;  ///< name of the option, or kDefaults
  double value;       ///< NaN with kDefaults
  GlobeOptions globe;
  CubeMapping mapping = CubeMapping::tangent;
};

inline constexpr const char* kDefaults = "default";
inline constexpr const char* kTessellation = "tessellation";
inline constexpr const char* kThreshold = "threshold";
inline constexpr const char* kPlainThreshold =
    "threshold, plain mapping";                           ///< paper 1's formula (1) in place of the tangent
inline constexpr const char* kDetail = "detail";          ///< requested texels per pixel
inline constexpr const char* kColumns = "polar columns";  ///< on the full grid
inline constexpr const char* kGutter = "gutter";

[[nodiscard]] std::vector<AccuracySetting> accuracy_settings(Effort effort);

struct AccuracyView {
  std::string name;
  truth::TruthCamera camera;
  std::string twin = {};   ///< views over the pole: the view over the equator from the same height
  bool magnified = false;  ///< every texel is larger than a pixel; even the finest tiles are too coarse
};
[[nodiscard]] std::vector<AccuracyView> accuracy_views(Effort effort);

/// Selection options of a globe with these options, without those for translucency.
[[nodiscard]] PatchSelectionOptions selection_of(const GlobeOptions& options);

}  // namespace terrella::bench
