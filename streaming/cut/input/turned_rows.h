#pragma once

#include <memory>
#include <string>

#include "streaming/cut/input/row_reader.h"

namespace terrella {

/// Turns an opaque picture upright by its EXIF orientation, 2…8. Orientation 2 mirrors each row as it is read. The
/// others hold the whole picture, 3 bytes a pixel; a picture that needs more than kMaxHeldBytes is refused with the
/// jpegtran command that turns the file. `name` is the file's path, for messages.
[[nodiscard]] Result<std::unique_ptr<RowReader>> turned_rows(std::unique_ptr<RowReader> stored, int orientation,
                                                             const std::string& name);

}  // namespace terrella
