#pragma once

#include <memory>
#include <optional>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/input/row_reader.h"

namespace terrella {

/// The pictures of a cut, opened as one.
struct CutInput {
  std::unique_ptr<RowReader> rows;
  std::optional<GeoRect> bounds;           ///< what they say of themselves; none: nothing, or the whole planet
  std::string resample_command{};          ///< of GDAL, for pixels that fit no grid; empty: they say no place
  std::optional<ElevationInfo> elevation;  ///< rows are heights (PixelKind::height)
};
[[nodiscard]] Result<CutInput> open_input(const CutOptions& options);

/// What the only picture of a cut says that it covers; none: nothing, or the whole planet. Fails if the cut may not go
/// on by what the picture says of its place, body or latitudes. Bounds in the options stand over what it says of its
/// place. thread: any
[[nodiscard]] Result<std::optional<GeoRect>> said_bounds(const CutOptions& options);

}  // namespace terrella
