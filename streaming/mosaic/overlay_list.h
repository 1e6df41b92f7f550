#pragma once

#include <filesystem>

#include "base/result.h"
#include "streaming/mosaic/mosaic_list.h"

namespace terrella {

/// Reads the ground overlays of a KML or KMZ file as a mosaic: those that are shown, or all if none is. The pictures of
/// a KMZ file are unpacked into `unpacked`, unless they lie there since its last change. Fails if there is none. The
/// error names the file. Blocks. thread: any
[[nodiscard]] Result<MosaicList> read_overlay_list(const std::filesystem::path& path,
                                                   const std::filesystem::path& unpacked);

}  // namespace terrella
