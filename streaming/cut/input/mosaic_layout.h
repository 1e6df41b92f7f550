#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/georeference/placement.h"

namespace terrella {

/// A part of a mosaic, as it is found.
struct MosaicPart {
  std::filesystem::path path;
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  std::optional<Placement> place = {};
};

/// Parts that lie side by side from the west, all of one height.
struct MosaicRow {
  std::int64_t height_px = 0;
  std::vector<std::size_t> parts;  ///< by number, from 0
};

struct MosaicLayout {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  std::vector<MosaicRow> rows;    ///< from the north
  std::optional<GeoRect> bounds;  ///< if the parts say; none: the whole planet
};

/// How parts form one picture, without gaps and overlaps: by `grid` if it is given, else by NASA's names (A1 to D2
/// between other than letters and digits: columns of 90° from -180°, rows of 90° from the north), else by where the
/// parts say that they lie. The error names the part that does not fit, and its number from 1. Pure. thread: any
[[nodiscard]] Result<MosaicLayout> lay_out(const std::vector<MosaicPart>& parts, const std::optional<MosaicGrid>& grid);

}  // namespace terrella
