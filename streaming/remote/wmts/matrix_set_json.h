#pragma once

#include <string>

#include "base/result.h"
#include "streaming/remote/wmts/wmts_matrix_set.h"

namespace terrella {

/// Reads a tile matrix set as JSON: OGC 17-083r4 (2.0), and r2 (1.0). Sets whose rows have variable widths, or whose
/// corner is at the bottom, are refused by name. The error is the reason alone. thread: any
[[nodiscard]] Result<WmtsMatrixSet> read_matrix_set_json(const std::string& text);

}  // namespace terrella
