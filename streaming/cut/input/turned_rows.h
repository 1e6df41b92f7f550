#pragma once

#include <memory>
#include <string>

#include "streaming/cut/input/row_reader.h"

namespace terrella {

/// Turns a picture upright by its EXIF orientation, 1…8, unless a file beside it places the stored rows.
/// Orientation 2 mirrors each row as it is read. The others hold the whole picture, 3 bytes a pixel, 4 with alpha; a
/// picture that needs more than kMaxHeldBytes is refused with the jpegtran command that turns a JPEG. `name` is the
/// file's path, for messages.
[[nodiscard]] Result<std::unique_ptr<RowReader>> upright_rows(std::unique_ptr<RowReader> stored, int orientation,
                                                              const std::string& name);

}  // namespace terrella
