#pragma once

#include <memory>
#include <optional>

#include "geo/result.h"
#include "streaming/cut.h"
#include "streaming/cut/row_reader.h"

namespace terrella {

/// The pictures of a cut, opened as one.
struct CutInput {
  std::unique_ptr<RowReader> rows;
  std::optional<GeoRect> bounds;           ///< what they say of themselves; none: nothing, or the whole planet
  std::optional<ElevationInfo> elevation;  ///< rows are heights (PixelKind::height)
};
[[nodiscard]] Result<CutInput> open_input(const CutOptions& options);

}  // namespace terrella
