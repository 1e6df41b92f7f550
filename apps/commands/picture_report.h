#pragma once

#include <string>
#include <vector>

#include "apps/commands/picture_facts.h"

namespace terrella {

/// Describes a picture for `terrella info`, as lines of text or one JSON object: its metadata, and how `view` would
/// show it. thread: any
[[nodiscard]] std::string picture_report(const PictureFacts& facts, bool json);

/// The place and the meaning of a raster's pixels for a panel, a line each, as `terrella info` prints them: system,
/// bounds, pixels, no data, values. Empty for a file that is no picture. Blocks, up to a second. thread: any
[[nodiscard]] std::vector<std::string> raster_facts(const std::filesystem::path& picture, const PlaceWords& words,
                                                    const DescribedBand& band);

}  // namespace terrella
