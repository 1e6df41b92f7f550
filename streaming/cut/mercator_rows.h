#pragma once

#include <memory>

#include "geo/ellipsoid.h"
#include "streaming/cut/cut_plan.h"
#include "streaming/cut/input/row_reader.h"

namespace terrella {

/// The rows of a plan in Web Mercator (mercator_plan()), resampled from the rows of the picture that the plan is made
/// of. Columns and rows are summed by the filters of the warp, so that alpha is the fraction of a pixel that the
/// picture covers. Holds some rows of the plan (8 MiB, at least one) and the picture's rows under them with those
/// around them that the filter needs, 16 bytes a pixel. `numbers`: rows are 32-bit floats, NaN for no data. `jobs`
/// threads do the sums; 0: one for each core.
[[nodiscard]] std::unique_ptr<RowReader> mercator_rows(std::unique_ptr<RowReader> rows, const CutPlan& picture,
                                                       const CutPlan& plan, const Ellipsoid& figure, bool numbers,
                                                       int jobs);

}  // namespace terrella
