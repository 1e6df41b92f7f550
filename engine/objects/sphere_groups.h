#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/object_batches.h"

namespace terrella {

/// What spheres are looked at from, as shaders/frame.glsl has it.
struct SphereSight {
  glm::mat3 view_from_ecef;  ///< sheared in an off-axis picture
  glm::vec3 eye_high_m, eye_low_m;
  glm::vec2 clip_scale;
  float focal_px = 0.0F;          ///< pixels that a metre covers at a metre's distance
  float hiding_radius_m = 0.0F;   ///< of a sphere around the planet's centre that hides what is behind it; 0: none
  float largest_point_px = 0.0F;  ///< radius of the widest spheres that may be points; 0: none may
};

/// Spheres in groups of neighbours, with a ball around each group: what cannot be seen is left out group by group.
/// Opaque spheres are sorted into cubes of space. Translucent ones keep the scene's order, in which they blend.
/// Pure values; thread: any
class SphereGroups {
 public:
  static constexpr std::size_t kMostInGroup = 64;

  /// Spheres of items() that follow each other.
  using Run = Batch<DotInstance>::Range;
  struct Seen {
    std::vector<Run> triangles;  ///< drawn as triangles around their outlines
    std::vector<Run> points;     ///< small, opaque and wholly in the picture: may be drawn as points
  };

  SphereGroups() = default;
  explicit SphereGroups(const Batch<DotInstance>& spheres);
  [[nodiscard]] const std::vector<DotInstance>& items() const { return items_; }
  /// Of a range of the batch, what may be seen: all that is, and some that is not.
  [[nodiscard]] Seen seen(Run range, const SphereSight& sight) const;

 private:
  struct Group {
    Run run;
    bool opaque;
    glm::vec3 high_m, low_m;  ///< the ball's centre
    float radius_m;           ///< of the ball
    float largest_m;          ///< radius of the largest sphere
  };
  enum class Look { hidden, triangles, points };
  [[nodiscard]] static Look look_of(const Group& group, const SphereSight& sight);
  [[nodiscard]] Group group_of(Run run) const;
  void add_groups(Run run, bool opaque);
  void add_cubes(Run run, const std::vector<std::uint32_t>& places, std::size_t zeroth, unsigned bits);

  std::vector<DotInstance> items_;
  std::vector<Group> groups_;
};

}  // namespace terrella
