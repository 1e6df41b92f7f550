#pragma once

#include <memory>

#include "streaming/cut.h"
#include "streaming/cut/input/row_reader.h"

namespace terrella {

/// Returns the same rows, and gives them to CutOptions::watch. Rows that are skipped are given too.
/// CutOptions::progress can stop the skipping.
[[nodiscard]] std::unique_ptr<RowReader> watched_rows(std::unique_ptr<RowReader> rows, const CutOptions& options);

}  // namespace terrella
