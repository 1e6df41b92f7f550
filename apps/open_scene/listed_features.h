#pragma once

#include <vector>

#include "geo/objects.h"
#include "objects/object_pick.h"

namespace terrella {

/// A feature of an object layer, as a list shows it.
struct ListedFeature {
  ObjectIdentity of = {};
  ObjectKind kind = ObjectKind::point;  ///< kind of the part that has the place
  Geodetic place = {};
  HeightMode heights = HeightMode::absolute;
};

/// Returns the features of a scene that have an id, in ascending order of ids. A feature of several parts has the place
/// of a point, else of a model, a line, an area or a label; of several lines or areas, that of the largest. The place
/// of a line is its middle. The place of an area lies inside: half way between two edges, on the parallel in the
/// middle. thread: any
[[nodiscard]] std::vector<ListedFeature> listed_features(const ObjectScene& scene);

}  // namespace terrella
