#pragma once

#include <filesystem>

#include "streaming/sets/tms_xml.h"

namespace terrella {

/// Detects the number of root tiles of a set by gdal2tiles.py --profile=geodetic. That program makes sets with two root
/// tiles (--tmscompatible) or one, and describes both as having two. This function looks at the columns and rows of the
/// finest level in `root`. If they belong to one root tile, it doubles the root span of `tms` and leaves out level 0,
/// whose tile begins at -90° and ends at 270°.
[[nodiscard]] Result<TmsDescription> correct_tms_roots(TmsDescription tms, const std::filesystem::path& root);

}  // namespace terrella
