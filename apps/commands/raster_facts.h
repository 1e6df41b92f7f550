#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/open_scene/open_rasters.h"
#include "streaming/georeference/georeference.h"
#include "streaming/raster/open_raster.h"

namespace terrella {

/// Reads facts about the pixels of a layer's raster for a panel, a line each, as `terrella info` prints them: bands,
/// no data, values, system, bounds, pixel size. Blocks, up to a second. thread: any
using FactsReader = std::function<std::vector<std::string>()>;

/// The facts of a picture; none for another file. Blocks, up to a second. thread: any
[[nodiscard]] std::vector<std::string> raster_facts(const std::filesystem::path& picture, const PlaceWords& words,
                                                    const DescribedBand& band);
/// The facts of a TIFF on a server whose directories and place are read. thread: any
[[nodiscard]] std::vector<std::string> raster_facts(const RemotePicture& tiff, const PlaceWords& words,
                                                    const DescribedBand& band);
/// The facts of many rasters that are one layer. thread: any
[[nodiscard]] std::vector<std::string> raster_facts(const MosaicFacts& mosaic);

/// The reader for TILESET. Facts of a TIFF on a server and of many rasters are read now, from `opened`; a local file is
/// read when it is asked for. Empty for anything else. thread: any
[[nodiscard]] FactsReader facts_reader(const Url& tile_set, const PlaceWords& words, const DescribedBand& band,
                                       const OpenedRasters& opened);

/// Lines of `terrella info` about many rasters. thread: any
[[nodiscard]] std::string mosaic_lines(const MosaicFacts& mosaic);

}  // namespace terrella
