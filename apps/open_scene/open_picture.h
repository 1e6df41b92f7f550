#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "apps/open_scene/options/source_options.h"
#include "base/result.h"
#include "streaming/cut.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Receives the picture's rows cut so far and the total; false requests a stop.
using CutProgress = std::function<bool(std::int64_t done, std::int64_t total)>;

/// Opens a picture. A TIFF that shows at once is read in place (streaming/warp/direct_tiles.h), and nothing of it is
/// cached. Other pictures are cut into the cache on first use, with a progress bar on standard error; `progress`
/// replaces the bar. With SourceOptions::cuts, a picture that is not cut yet opens at once, and its cut goes on in the
/// background. The error names the picture. thread: any, one at a time
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_picture(const std::filesystem::path& picture,
                                                               const SourceOptions& options,
                                                               const CutProgress& progress);

/// Gives the words to a cut. thread: any
void set_place(CutOptions& cut, const PlaceWords& words);

/// Gives the choices to a cut, which with a `format` makes a picture of numbers unless they are asked for.
/// `holds_numbers`: the raster is shown as numbers unless the user says otherwise. thread: any
void set_numbers(CutOptions& cut, const NumberOptions& options, bool holds_numbers);
/// Makes the reader of a raster that is shown directly read what a cut would. thread: any
void set_numbers(RasterOptions& reading, const CutOptions& cut);

}  // namespace terrella
