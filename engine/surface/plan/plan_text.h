#pragma once

#include <string>

#include "surface/plan/frame_plan.h"

namespace terrella {

/// A plan in lines of text: one for each layer, patch, requested tile and mesh. Numbers have six significant digits.
/// Equal plans have equal texts. thread: any
[[nodiscard]] std::string to_text(const FramePlan& plan);

}  // namespace terrella
