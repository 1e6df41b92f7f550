#pragma once

#include <functional>
#include <memory>

#include "streaming/cut/input/mosaic_layout.h"
#include "streaming/cut/input/row_reader.h"

namespace terrella {

using OpenRows = std::function<Result<std::unique_ptr<RowReader>>(const std::filesystem::path&)>;

/// Reads the parts as one picture. Keeps only one row of parts open at a time. `info` gives size and transparency.
[[nodiscard]] std::unique_ptr<RowReader> make_mosaic_rows(std::vector<MosaicPart> parts, MosaicLayout layout,
                                                          const PictureInfo& info, OpenRows open);

}  // namespace terrella
