#pragma once

#include <string>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/truth/ray_caster.h"
#include "globe/globe.h"
#include "surface/patch_selection.h"

namespace terrella::bench {

/// One value of one of the globe's options, the others at their defaults.
struct AccuracySetting {
  const char* sweep;  ///< which option; kDefaults: none
  double value;       ///< NaN with kDefaults
  GlobeOptions globe;
};

inline constexpr const char* kDefaults = "default";
inline constexpr const char* kTessellation = "tessellation";
inline constexpr const char* kThreshold = "threshold";
inline constexpr const char* kPlainThreshold = "threshold, plain mapping";  ///< paper 1's (1) in place of the tangent
inline constexpr const char* kDetail = "detail";                            ///< texels a pixel that are asked for
inline constexpr const char* kColumns = "polar columns";                    ///< on the full grid
inline constexpr const char* kGutter = "gutter";

[[nodiscard]] std::vector<AccuracySetting> accuracy_settings(Effort effort);

struct AccuracyView {
  std::string name;
  truth::TruthCamera camera;
  std::string twin = {};   ///< of a view over the pole: that over the equator from as high
  bool magnified = false;  ///< every texel is larger than a pixel: the finest tiles are all there is
};
[[nodiscard]] std::vector<AccuracyView> accuracy_views(Effort effort);

/// The selection that a globe with these options makes, but for what is about translucency.
[[nodiscard]] PatchSelectionOptions selection_of(const GlobeOptions& options);

}  // namespace terrella::bench
