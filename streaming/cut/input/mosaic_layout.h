#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/georeference/placement.h"

namespace terrella {

/// A part of a mosaic, as found on disk.
struct MosaicPart {
  std::filesystem::path path;
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  std::optional<Placement> place = {};
};

/// Parts side by side from the west, all of the same height.
struct MosaicRow {
  std::int64_t height_px = 0;
  std::vector<std::size_t> parts;  ///< indices from 0
};

struct MosaicLayout {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  std::vector<MosaicRow> rows;     ///< ordered from the north
  std::optional<Placement> place;  ///< stated by the parts; none: the whole planet
};

/// Arranges parts into one picture without gaps and overlaps. Uses `grid` if given. Otherwise uses NASA's names: A1 to
/// D2 between characters that are neither letters nor digits; columns of 90° from -180°, rows of 90° from the north.
/// Otherwise uses the places stated by the parts. The error names the part that does not fit, and its number from 1.
/// Pure. thread: any
[[nodiscard]] Result<MosaicLayout> lay_out(const std::vector<MosaicPart>& parts, const std::optional<MosaicGrid>& grid);

}  // namespace terrella
