#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A level of a tilemapresource.xml in a coordinate system of its own.
struct TmsUnits {
  double unit_per_px = 0.0;
  std::string folder;
};

/// A finite number that fills its attribute; NaN for others. thread: any
[[nodiscard]] double tms_number(const pugi::xml_node& node, const char* attribute);

/// Places the levels of a <TileMap>, coarsest first, whose <SRS> is any system that PROJ knows. Tiles begin at
/// <Origin>, the south-west corner, and reach over the <BoundingBox>, so that each level has a north-west corner of its
/// own. Both have the easting as x. Sets grid, square and body; the tile size is that of `info`. The error is the
/// reason alone. thread: any
[[nodiscard]] Status place_tms_levels(const pugi::xml_node& map, const std::vector<TmsUnits>& levels,
                                      TileSetInfo& info);

}  // namespace terrella
