#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"

namespace terrella {

/// What a picture says of itself and what `view` would do with it, for `terrella info`: lines of text, or one JSON
/// object. Reads the header and the files beside it, no pixels. Fails if the file is no picture that can be read.
/// thread: any
[[nodiscard]] Result<std::string> picture_report(const std::filesystem::path& picture, bool json);

}  // namespace terrella
