#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/input/row_reader.h"

namespace terrella {

/// All pictures of a cut, opened as one picture whose pixels are those of a grid.
struct CutInput {
  std::unique_ptr<RowReader> rows;
  std::optional<GeoRect> bounds{};  ///< none: the whole planet
  LatitudeKind latitude = LatitudeKind::graphic;
  std::string place;                                   ///< place_text()
  std::optional<NumberInfo> numbers{};                 ///< set if the rows are numbers (PixelKind::height and number)
  bool has_gaps = false;                               ///< pixels may lie beside the picture
  std::vector<std::string> remarks{};                  ///< for the user
  std::shared_ptr<const std::atomic<int>> left_out{};  ///< files that could not be read so far; null: none
};
[[nodiscard]] Result<CutInput> open_input(const CutOptions& options);

/// The bands that a picture shows, as the readers count them.
[[nodiscard]] CodingOptions choice_of(const CutOptions& options);

}  // namespace terrella
