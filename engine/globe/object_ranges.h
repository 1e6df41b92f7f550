#pragma once

#include "base/result.h"
#include "geo/object_edits.h"
#include "geo/objects.h"

namespace terrella {

/// Checks the values of objects and edits: places, sizes, models, icons. The error names the first object, counted from
/// 0 in its list, and the value that is out of its range. Shared models and icons are checked once. thread: any
[[nodiscard]] Status check_values(const ObjectScene& scene);
[[nodiscard]] Status check_values(const ObjectMove& move);
[[nodiscard]] Status check_values(const ObjectChange& change);
[[nodiscard]] Status check_values(const LineGrowth& growth);
[[nodiscard]] Status check_values(const ObjectShape& shape);

}  // namespace terrella
