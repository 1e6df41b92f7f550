#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>

#include "geo/camera.h"
#include "geo/objects.h"
#include "view/ground.h"

namespace terrella {

/// Which list of an ObjectScene.
enum class ObjectKind { point, line, polygon, mesh };

struct PickedObject {
  ObjectKind kind = ObjectKind::point;
  std::size_t index = 0;    ///< in its list
  double distance_m = 0.0;  ///< from the eye
};

/// Objects that the ground does not hide from the eye.
struct PickOptions {
  bool through_ground = false;  ///< a translucent surface hides only what lies on the globe's far side
  double slack_px = 2.0;        ///< added to markers and lines: they are thin
};

/// The object under a pixel (as in geo/coordinates.h): the nearest to the eye; of those that lie as far from it,
/// points before lines before areas, and the later before the earlier. Markers and lines by their size on the screen,
/// spheres and areas by their shape, meshes by the sphere that holds them. Takes time with all objects of the scene,
/// about a microsecond for each corner. thread: as Ground's
[[nodiscard]] std::optional<PickedObject> pick_object(const View& view, const Ground& ground, const ObjectScene& scene,
                                                      glm::dvec2 pixel_px, const PickOptions& options = {});

/// True if the ground or the globe stands between the eye and a place. Ground within a thousandth of the distance to
/// the place does not count. thread: as Ground's
[[nodiscard]] bool hidden_by_ground(const View& view, const Ground& ground, const Ecef& place);

}  // namespace terrella
