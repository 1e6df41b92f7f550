#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/place_words.h"
#include "streaming/raster/open_raster.h"

namespace terrella {

/// Describes a picture for `terrella info`, as lines of text or one JSON object: its metadata, and how `view` would
/// show the picture with the given words about its place. Reads the header and the files beside the picture, but no
/// pixels. Fails if the file is not a readable picture. thread: any
[[nodiscard]] Result<std::string> picture_report(const std::filesystem::path& picture, const PlaceWords& words,
                                                 const DescribedBand& band, bool json);

/// The place and the meaning of a raster's pixels for a panel, a line each, as `terrella info` prints them: system,
/// bounds, pixels, no data, values. Empty for a file that is no picture. Blocks, up to a second. thread: any
[[nodiscard]] std::vector<std::string> raster_facts(const std::filesystem::path& picture, const PlaceWords& words,
                                                    const DescribedBand& band);

}  // namespace terrella
