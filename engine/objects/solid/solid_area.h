#pragma once

#include <vector>

#include "geo/ellipsoid.h"
#include "geo/objects.h"
#include "objects/object_batches.h"
#include "objects/object_shapes.h"
#include "view/ground.h"

// Extruded areas: a roof, and walls under its edges.
namespace terrella {

/// Returns an extruded area with heights over the ellipsoid: the base at the lowest ground under its edges, and the
/// roof as high over the mean ground under its places as the area says. thread: as Ground's
[[nodiscard]] PolygonObject standing_shape(PolygonObject area, const Ground& ground);

/// Returns the roof of an extruded area, whose heights are absolute, as a flat area. thread: any
[[nodiscard]] PolygonObject roof_of(PolygonObject area);

/// Returns triangles, counterclockwise from outside and without a colour: the mesh of the roof, and walls from there
/// down to the base. `step` is the longest piece of a wall. A wall of a ring that crosses itself, or of a hole in a
/// hole, may face inwards. thread: any
[[nodiscard]] std::vector<SolidVertex> solid_of(const PolygonObject& area, const FillMesh& roof,
                                                const Ellipsoid& ellipsoid, Angle step);

}  // namespace terrella
