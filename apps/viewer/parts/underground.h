#pragma once

#include <optional>

#include "apps/viewer/parts/part.h"

namespace terrella {

/// Takes the eye under the ground and back. Owns the eye's place before it went down. thread: main
class Underground : public Part {
 public:
  /// A navigator whose eye is under the ellipsoid may stay there.
  explicit Underground(const ViewerContext& context);

  /// True if the eye is under the ground now.
  [[nodiscard]] bool is_below() const;
  /// Moves the eye under its place, as deep as it was high but above the inner sphere, looking up; or back.
  void toggle();
  /// Takes the eye back over the ground, if it is under the ground.
  void return_above();

 private:
  [[nodiscard]] double deepest_m() const;

  std::optional<Camera> above_;  ///< eye before it went under the ground
};

}  // namespace terrella
