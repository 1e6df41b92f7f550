#pragma once

#include <filesystem>

#include "streaming/sets/tms_xml.h"

namespace terrella {

/// gdal2tiles.py --profile=geodetic makes two kinds of sets, with two root tiles (--tmscompatible) or one, and
/// describes both as the former. This looks at the columns and rows of the finest level in `root` and, if they are
/// those of one root tile, doubles the root span of `tms`, whose level 0 then is left out (its tile begins at -90° and
/// ends at 270°).
[[nodiscard]] Result<TmsDescription> correct_tms_roots(TmsDescription tms, const std::filesystem::path& root);

}  // namespace terrella
