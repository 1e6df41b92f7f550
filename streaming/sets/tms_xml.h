#pragma once

#include <map>
#include <string>
#include <string_view>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

inline constexpr const char* kTmsFile = "tilemapresource.xml";
inline constexpr std::size_t kMaxTmsXmlBytes = 1UL << 20;

/// Content of a tilemapresource.xml (OSGeo Tile Map Service 1.0.0).
struct TmsDescription {
  TileSetInfo info;
  std::string extension;              ///< ending of the tile files, without a dot
  std::map<int, std::string> folder;  ///< folder of each level of the grid, from `href`
};

/// Reads a tilemapresource.xml, geodetic, in Web Mercator or in another system (tms_projected.h). A TMS counts rows
/// from -90°. Levels whose tiles do not divide 180° (level 0 of a set with one root tile) do not lie on a TileGrid and
/// are left out. The error begins with `where`. thread: any
[[nodiscard]] Result<TmsDescription> parse_tms_xml(std::string_view text, const std::string& where);

}  // namespace terrella
