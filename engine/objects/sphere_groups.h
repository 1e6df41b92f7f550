#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/object_batches.h"

namespace terrella {

/// The view of spheres, in the terms of shaders/frame.glsl.
struct SphereSight {
  glm::mat3 view_from_ecef;  ///< contains the shear of an off-axis picture
  glm::vec3 eye_high_m, eye_low_m;
  glm::vec2 clip_scale;
  float focal_px = 0.0F;  ///< pixels per metre at a distance of one metre
  /// Radius of a sphere around the planet's centre that hides the objects behind it; 0: none.
  float hiding_radius_m = 0.0F;
  float largest_point_px = 0.0F;  ///< radius of the largest spheres that may be drawn as points; 0: none may
};

/// Spheres in groups of neighbours, each with a bounding ball. Invisible groups are culled as a whole. Opaque spheres
/// are grouped by cubes of space. Translucent spheres keep the layer's order, in which they are blended. thread: any,
/// but one call at a time
class SphereGroups {
 public:
  static constexpr std::size_t kMostInGroup = 64;

  /// A run of consecutive spheres in items().
  using Run = Batch<DotInstance>::Range;
  struct Seen {
    std::vector<Run> triangles;  ///< drawn as triangles around their outlines
    std::vector<Run> points;     ///< small, opaque and wholly in the picture: may be drawn as points
  };

  SphereGroups() = default;
  explicit SphereGroups(const Batch<DotInstance>& spheres);
  [[nodiscard]] const std::vector<DotInstance>& items() const { return items_; }
  /// Index in the batch of the sphere at `k` of items().
  [[nodiscard]] std::size_t source(std::size_t k) const { return sources_[k]; }
  /// Replaces the sphere at `k` of items(), for example moves it. Its group's ball grows or shrinks.
  void set(std::size_t k, const DotInstance& sphere);
  /// Returns the possibly visible spheres of a range of the batch: all visible ones, and some that are not.
  [[nodiscard]] Seen seen(Run range, const SphereSight& sight);

 private:
  struct Group {
    Run run;
    bool opaque;
    glm::vec3 high_m, low_m;  ///< centre of the ball
    float radius_m;           ///< radius of the ball
    float largest_m;          ///< radius of the largest sphere
    bool stale = false;       ///< the ball is not that of the spheres any more
  };
  enum class Look { hidden, triangles, points };
  [[nodiscard]] static Look look_of(const Group& group, const SphereSight& sight);
  [[nodiscard]] Group group_of(Run run) const;
  void add_groups(Run run, bool opaque);
  void add_cubes(Run run, const std::vector<std::uint32_t>& places, std::size_t zeroth, unsigned bits);

  std::vector<DotInstance> items_;
  std::vector<std::uint32_t> sources_;
  std::vector<Group> groups_;
};

}  // namespace terrella
