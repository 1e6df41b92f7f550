#pragma once

#include <string>

#include "base/result.h"

namespace terrella {

/// Checks a file that may be a description of other rasters (VRT): every source that it names must be a file in its own
/// folder or below it, so that no description reads other files of this machine, or a network. Other files pass. The
/// error names the file and the source. Blocks. thread: any
[[nodiscard]] Status check_vrt_sources(const std::string& path);

}  // namespace terrella
