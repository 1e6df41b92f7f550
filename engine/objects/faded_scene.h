#pragma once

#include "geo/objects.h"

namespace terrella {

/// The same objects, their alpha times `opacity`, [0, 1]; opaque parts of meshes become translucent ones. Models that
/// several meshes share stay shared. thread: any
[[nodiscard]] ObjectScene faded(ObjectScene scene, double opacity);

}  // namespace terrella
