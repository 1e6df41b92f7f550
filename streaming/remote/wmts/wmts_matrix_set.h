#pragma once

#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"

namespace terrella {

/// A <TileMatrix>, as numbers that are in range.
struct WmtsMatrix {
  std::string name{};
  double scale_denominator = 0.0;
  std::pair<double, double> corner{};  ///< TopLeftCorner as written: which is the latitude, wmts_grid decides
  int tile_px = 0;
  std::int64_t columns = 0;
  std::int64_t rows = 0;
};

/// A <TileMatrixSet> of the contents, coarsest matrix first.
struct WmtsMatrixSet {
  std::string name{};
  std::string crs{};  ///< SupportedCRS as written
  std::vector<WmtsMatrix> matrices{};
};

/// A <TileMatrixLimits>: the tiles that a layer has of a matrix, first and last included.
struct WmtsLimits {
  std::string matrix{};
  std::int64_t first_column = 0, last_column = 0, first_row = 0, last_row = 0;
};

/// Reads a <TileMatrixSet>. The error is the reason alone, without the name of document or set. thread: any
[[nodiscard]] Result<WmtsMatrixSet> read_matrix_set(const pugi::xml_node& node);

/// Reads the limits of a <TileMatrixSetLink>; those that are no numbers are passed over. thread: any
[[nodiscard]] std::vector<WmtsLimits> read_limits(const pugi::xml_node& link);

}  // namespace terrella
