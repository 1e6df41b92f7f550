#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/remote/gdal_wms/gdal_wms_document.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// The place of a window's tiles.
struct GdalWmsGrid {
  TileGrid grid;
  std::optional<CrsSquare> square;  ///< set: the tiles lie on no geodetic grid and on no grid of Web Mercator
  std::vector<TileShift> shifts;    ///< by level
  std::vector<std::string> level_names;
  std::string body;
};

/// Finds the grid of the window: geodetic if its system has evenly spaced degrees and its corner and its levels lie on
/// whole tiles, Web Mercator if they do so there, else the window's own square. Windows of a WMS, whose tiles may lie
/// anywhere, get the grids of choose_wms_grid(). The error is the reason alone. thread: any
[[nodiscard]] Result<GdalWmsGrid> place_gdal_window(const GdalWmsDocument& said);

}  // namespace terrella
