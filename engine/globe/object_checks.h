#pragma once

#include <span>

#include "base/result.h"
#include "geo/objects.h"

namespace terrella {

class LayerObjects;

/// Fails if objects cannot be added to a layer: a value is out of its range (object_ranges.h), there are more than
/// kMostIcons icons, or an id already names another feature. `there`: the layer's objects, of which `removed` go
/// before; null: none. thread: main
[[nodiscard]] Status check_objects(const ObjectScene& added, const LayerObjects* there = nullptr,
                                   std::span<const ObjectId> removed = {});

}  // namespace terrella
