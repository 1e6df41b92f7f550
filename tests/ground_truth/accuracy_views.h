#pragma once

#include <string>
#include <vector>

#include "apps/bench/truth/judge.h"

namespace terrella::truth {

/// Limit for a figure of a view.
struct Bound {
  enum class Kind {
    figure,      ///< RMS ≤ value
    other_zone,  ///< RMS ≤ value × RMS of `reference` in the same view
    other_view,  ///< RMS ≤ value × RMS of `reference` in `reference_view`, which stands earlier in the list
  };
  Zone zone;
  Kind kind = Kind::figure;
  double value = 0.0;
  Zone reference = Zone::all;
  std::string reference_view = {};
};

/// A picture to render and to judge. The camera and body go to the program and to the ray caster alike.
struct AccuracyView {
  std::string name;
  std::string planet;  ///< "noise" or "blue_marble"
  Spheroid body;
  RowRule rows;
  TruthCamera camera;
  int size_px = 1024;
  std::vector<Bound> bounds;
};

/// Shares that every view is held to.
inline constexpr double kSurroundings = 1.02;  ///< antimeridian and tile borders: no worse than beside them by over 2 %
inline constexpr double kLimbShare = 0.0005;   ///< pixels outside the limb off by over 40 levels

[[nodiscard]] std::vector<AccuracyView> accuracy_views();

}  // namespace terrella::truth
