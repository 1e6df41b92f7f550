#include "streaming/convert/web_tiles.h"

#include <fmt/format.h>

#include <cmath>

namespace terrella {

Status check_web_tiles(const std::filesystem::path& output, const TileSetInfo& info) {
  const char* format = output.extension() == ".pmtiles" ? "PMTiles" : "MBTiles";
  if (info.grid.projection != Projection::web_mercator) {
    return Error{fmt::format(
        "{}: {} holds tiles in Web Mercator alone, and this set is in another grid; name an output that ends in .gpkg, "
        "or a folder, which hold every grid",
        output.string(), format)};
  }
  if (info.numbers) {
    return Error{fmt::format(
        "{}: {} holds pictures alone, and the tiles of this set are numbers, such as heights; name an output that ends "
        "in .gpkg, or a folder",
        output.string(), format)};
  }
  if (zoom_of_roots(info.grid) + info.grid.max_level > kMaxTileLevel) {
    return Error{fmt::format("{}: the set has tiles finer than zoom {}; name an output that ends in .gpkg, or a folder",
                             output.string(), kMaxTileLevel)};
  }
  return Done{};
}

int zoom_of_roots(const TileGrid& grid) { return static_cast<int>(std::lround(std::log2(360.0 / grid.root_span_deg))); }

GeoRect web_bounds(const TileGrid& grid) {
  GeoRect bounds = grid.bounds;
  if (bounds.east < bounds.west) {
    bounds.west = Angle::degrees(-180.0);
    bounds.east = Angle::degrees(180.0);
  }
  bounds.south = std::max(bounds.south, Angle::degrees(-kMercatorEndDeg));
  bounds.north = std::min(bounds.north, Angle::degrees(kMercatorEndDeg));
  return bounds;
}

const char* layer_type(ImageFormat format) { return format == ImageFormat::jpeg ? "baselayer" : "overlay"; }

Error no_tiles_to_write(const std::filesystem::path& output) {
  return Error{
      fmt::format("{}: the set has no tiles, and such a file cannot be read; nothing was written", output.string())};
}

}  // namespace terrella
