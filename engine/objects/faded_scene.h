#pragma once

#include "geo/objects.h"

namespace terrella {

/// Returns the same objects with alpha times `opacity`, [0, 1]. Opaque parts of meshes become translucent. Models that
/// several meshes share stay shared. thread: any
[[nodiscard]] ObjectScene faded(ObjectScene scene, double opacity);

}  // namespace terrella
