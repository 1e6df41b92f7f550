#pragma once

#include <functional>
#include <memory>

#include "streaming/cut/input/mosaic_layout.h"
#include "streaming/cut/input/row_reader.h"

namespace terrella {

using OpenRows = std::function<Result<std::unique_ptr<RowReader>>(const std::filesystem::path&)>;

/// The parts as one picture. Those of one row of parts are open at a time. `info` says size and transparency.
[[nodiscard]] std::unique_ptr<RowReader> make_mosaic_rows(std::vector<MosaicPart> parts, MosaicLayout layout,
                                                          const PictureInfo& info, OpenRows open);

}  // namespace terrella
