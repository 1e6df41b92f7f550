#pragma once

#include <memory>
#include <optional>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/input/row_reader.h"

namespace terrella {

/// All pictures of a cut, opened as one picture.
struct CutInput {
  std::unique_ptr<RowReader> rows;
  std::optional<GeoRect> bounds;   ///< place stated by the pictures; none if they state no place, or the whole planet
  std::string resample_command{};  ///< GDAL command for pixels that fit no grid; empty if the pictures state no place
  std::optional<ElevationInfo> elevation;  ///< set if the rows are heights (PixelKind::height)
};
[[nodiscard]] Result<CutInput> open_input(const CutOptions& options);

/// Returns the area that the only picture of a cut states for itself; none if it states nothing, or the whole planet.
/// Fails if the picture's place, body or latitudes do not allow the cut. Bounds in the options override the place in
/// the picture. thread: any
[[nodiscard]] Result<std::optional<GeoRect>> said_bounds(const CutOptions& options);

}  // namespace terrella
