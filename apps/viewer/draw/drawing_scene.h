#pragma once

#include <cstddef>

#include "apps/viewer/draw/drawing.h"
#include "geo/object_edits.h"
#include "geo/objects.h"

// thread: any, for all of this header
namespace terrella {

/// Objects of the globe for a drawing. They lie on the ground, and have the ids of their marks. Named lines and areas
/// have a label in their middle. `scale` is the size of markers and lines, 1 at 96 dots per inch.
[[nodiscard]] ObjectScene drawing_scene(const Drawing& drawing, float scale);

/// Edits that turn the objects of one drawing into those of another. Only marks that differ are edited.
[[nodiscard]] ObjectEdits drawing_edits(const Drawing& before, const Drawing& after, float scale);

/// The marks that a scene holds.
struct SceneDrawing {
  Drawing drawing;
  std::size_t left_out = 0;  ///< objects that no mark can be: areas with holes, bodies, models, spheres, icons
};

/// Reads marks from the objects of a file, in the order of their ids. Names come from the features' properties. Heights
/// and other properties are dropped.
[[nodiscard]] SceneDrawing drawing_of(const ObjectScene& scene);

}  // namespace terrella
