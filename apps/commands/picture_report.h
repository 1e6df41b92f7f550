#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"
#include "streaming/georeference/place_words.h"
#include "streaming/raster/open_raster.h"

namespace terrella {

/// Describes a picture for `terrella info`, as lines of text or one JSON object: its metadata, and how `view` would
/// show the picture with the given words about its place. Reads the header and the files beside the picture, but no
/// pixels. Fails if the file is not a readable picture. thread: any
[[nodiscard]] Result<std::string> picture_report(const std::filesystem::path& picture, const PlaceWords& words,
                                                 const DescribedBand& band, bool json);

}  // namespace terrella
