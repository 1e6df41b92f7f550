#pragma once

#include <memory>

#include "streaming/cut/input/row_reader.h"

namespace terrella {

/// Returns rows of `turn_px` columns from -180°. The reader's first column is the column `first_column` of them, and
/// its columns go on at column 0 after the last one. Columns that the reader does not have are transparent, or heights
/// that are not known. The reader is at most `turn_px` wide.
[[nodiscard]] std::unique_ptr<RowReader> rolled_rows(std::unique_ptr<RowReader> reader, std::int64_t first_column,
                                                     std::int64_t turn_px, bool heights);

}  // namespace terrella
