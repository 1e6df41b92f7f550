#pragma once

#include <algorithm>
#include <filesystem>
#include <limits>

#include "base/result.h"
#include "tiles/tile_source.h"

/// Rules that MBTiles and PMTiles share: pictures in the web pyramid of EPSG:3857.
// thread: any, for all of this header
namespace terrella {

/// Fails if an MBTiles or a PMTiles file cannot hold the set. The error begins with the output's name.
[[nodiscard]] Status check_web_tiles(const std::filesystem::path& output, const TileSetInfo& info);

/// Level of the web pyramid that has the tiles of level 0 of a Web Mercator grid.
[[nodiscard]] int zoom_of_roots(const TileGrid& grid);

/// Bounds of the set within the square of Web Mercator; all longitudes if they cross ±180°.
[[nodiscard]] GeoRect web_bounds(const TileGrid& grid);

/// The layer's type in the metadata: a baselayer if its tiles have no transparency, else an overlay.
[[nodiscard]] const char* layer_type(ImageFormat format);

/// Levels that have tiles.
struct ZoomRange {
  int least = std::numeric_limits<int>::max();
  int most = -1;
  void add(int zoom) {
    least = std::min(least, zoom);
    most = std::max(most, zoom);
  }
  [[nodiscard]] bool empty() const { return most < 0; }
};

/// Formats of the tiles. Tiles that are no pictures are not counted.
struct TileFormats {
  ImageFormat first = ImageFormat::unknown;
  bool mixed = false;
  void add(ImageFormat format) {
    if (format == ImageFormat::unknown) return;
    if (first == ImageFormat::unknown) first = format;
    mixed = mixed || format != first;
  }
  /// The format of all tiles, `unknown` if they differ, `stated` if none is a picture.
  [[nodiscard]] ImageFormat common(ImageFormat stated) const {
    if (mixed) return ImageFormat::unknown;
    return first == ImageFormat::unknown ? stated : first;
  }
};

[[nodiscard]] Error no_tiles_to_write(const std::filesystem::path& output);

}  // namespace terrella
