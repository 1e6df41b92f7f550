#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_set>
#include <vector>

#include "geo/body.h"
#include "geo/camera.h"
#include "surface/plan/patch_selection.h"
#include "tests/geo/geo_test_support.h"

namespace terrella::test {

/// A side of the patches under test.
inline constexpr int kSegments = 16;

/// The bodies that the selection is tested on: Earth, a small one, the flattest planet, a perfect sphere.
inline std::vector<Body> selection_bodies() {
  std::vector<Body> bodies;
  for (const char* text : {"earth", "phobos", "6378137,0.098", "sphere"}) bodies.push_back(*parse_body(text));
  return bodies;
}

inline Camera camera_at(double lat, double lon, double height_m, double heading = 0.0, double pitch = -90.0,
                        double fov = 40.0) {
  return {.eye = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m},
          .heading = Angle::degrees(heading),
          .pitch = Angle::degrees(pitch),
          .fov_y = Angle::degrees(fov)};
}

/// A camera at a height that is log-uniform in [low_m, high_m], anywhere, any heading, any tilt from straight down to
/// straight up; one in four over a pole, a face's edge or the antimeridian.
inline Camera random_camera(Draw& draw, double low_m, double high_m) {
  const double height_m = std::exp(draw.between(std::log(low_m), std::log(high_m)));
  double lat = 90.0 - 180.0 / std::numbers::pi * std::acos(draw.between(-1.0, 1.0));
  double lon = draw.between(-180.0, 180.0);
  switch (draw.whole(0, 11)) {
    case 0:
      lat = draw.whole(0, 1) == 0 ? 90.0 : -90.0;
      break;
    case 1:
      lon = draw.whole(0, 1) == 0 ? 180.0 : -180.0;
      break;
    case 2:
      lon = 45.0 + 90.0 * draw.whole(-2, 1);
      break;
    default:
      break;
  }
  return camera_at(lat, lon, height_m, draw.between(0.0, 360.0), draw.between(-90.0, 90.0), draw.between(1.0, 120.0));
}

using PatchSet = std::unordered_set<PatchId, PatchIdHash>;

inline PatchSet ids_of(const std::vector<SelectedPatch>& patches) {
  PatchSet ids;
  for (const SelectedPatch& patch : patches) ids.insert(patch.node->id);
  return ids;
}

/// The selected patch that is `id` or contains it.
inline std::optional<PatchId> leaf_over(const PatchSet& leaves, PatchId id) {
  for (;; id = parent(id)) {
    if (leaves.contains(id)) return id;
    if (id.level == 0) return std::nullopt;
  }
}

/// A random patch of a level.
inline PatchId random_patch(Draw& draw, int level) {
  const std::uint32_t last = (1U << level) - 1U;
  return {.face = static_cast<CubeFace>(draw.whole(0, 5)),
          .level = level,
          .x = draw.whole<std::uint32_t>(0, last),
          .y = draw.whole<std::uint32_t>(0, last)};
}

/// The patches of a level on the way round a pole and along the antimeridian, where mistakes live.
inline PatchId patch_beside(double lat_deg, double lon_deg, int level) {
  return patch_at(Ellipsoid::normal(Angle::degrees(lat_deg), Angle::degrees(lon_deg)), level);
}

/// The node of a patch, made on the way down.
inline PatchNode& node_of(PatchTree& tree, const PatchId& id) {
  PatchNode* node = &tree.root(id.face);
  while (node->id.level < id.level) {
    tree.ensure_children(*node);
    const int shift = id.level - node->id.level - 1;
    node = node->children[((id.x >> shift) & 1U) + 2 * ((id.y >> shift) & 1U)];
  }
  return *node;
}

}  // namespace terrella::test
