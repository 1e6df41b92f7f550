#pragma once

#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"

namespace terrella {

/// A <TileMatrix> with numbers checked for range.
struct WmtsMatrix {
  std::string name{};
  double scale_denominator = 0.0;
  std::pair<double, double> corner{};  ///< TopLeftCorner as written; wmts_grid decides which number is the latitude
  int tile_px = 0;
  std::int64_t columns = 0;
  std::int64_t rows = 0;
};

/// A <BoundingBox> as written.
struct WmtsBox {
  std::pair<double, double> low{}, high{};
};

/// A <TileMatrixSet> of the contents, coarsest matrix first.
struct WmtsMatrixSet {
  std::string name{};
  std::string crs{};  ///< SupportedCRS as written
  std::vector<WmtsMatrix> matrices{};
  std::optional<WmtsBox> box{};
};

/// A <TileMatrixLimits>: tiles of a matrix in a layer, first and last included.
struct WmtsLimits {
  std::string matrix{};
  std::int64_t first_column = 0, last_column = 0, first_row = 0, last_row = 0;
};

/// Reads a <TileMatrixSet>. The error is the reason alone, without the name of document or set. thread: any
[[nodiscard]] Result<WmtsMatrixSet> read_matrix_set(const pugi::xml_node& node);

/// The limits of a matrix; null if there are none. Some servers write the name of the set before that of the matrix, as
/// "set:0". thread: any
[[nodiscard]] const WmtsLimits* limits_of(const std::vector<WmtsLimits>& limits, const std::string& matrix);

/// Reads the limits of a <TileMatrixSetLink>. Skips limits that are not numbers. thread: any
[[nodiscard]] std::vector<WmtsLimits> read_limits(const pugi::xml_node& link);

}  // namespace terrella
