#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/placement.h"
#include "streaming/raster/open_raster.h"
#include "streaming/raster/raster_source.h"
#include "tiles/tile_source.h"

namespace terrella {

/// The user's statements about a raster that is shown without being cut.
struct DirectOptions {
  std::string body{};                         ///< preset name or "A,F"; empty: the Earth
  std::optional<LatitudeKind> latitude = {};  ///< counted by the rows; default: as the raster states, else graphic
  PlaceWords place{};
  /// Grid of the raster's own pixels, so that tiles are copies of them; default: warp_grid().
  std::optional<TileGrid> grid = {};
  RasterOptions reading = {};  ///< content to read: a picture, numbers of a band, three bands
};

/// Place of a raster on the globe.
struct RasterPlace {
  CrsPlace at;  ///< for open_raster()
  LatitudeKind latitude = LatitudeKind::graphic;
  std::vector<std::string> remarks{};  ///< statements of the raster that the user's words overrule, for the user
};

/// Turns a checked place into the place of a raster. A raster that states nothing is the whole planet from -180° on, if
/// it is 2:1; otherwise nothing. The error is that of check_figure(). thread: any
[[nodiscard]] Result<std::optional<RasterPlace>> place_raster(PlacedPicture placed, const PictureFile& picture,
                                                              const DirectOptions& options);

/// Most pixels of the coarsest level. The first tile reads all of them, in about 0.2 s on two cores.
inline constexpr std::int64_t kMostCoarsestPixels = 1LL << 24;
/// The same for a file of this machine that has overviews: an eighth of 86400 x 43200, where GDAL's COGs of a JPEG end.
/// Reading them takes a second; the file's cut would take a minute.
inline constexpr std::int64_t kMostCoarsestOverviewPixels = 1LL << 26;

/// Largest factor between the sides of neighbouring levels. A tile between the two reads all pixels of the finer one
/// under it: about as many as a coarsest level may have.
inline constexpr double kMostLevelStep = 16.0;
/// Most blocks of the finer level that such a tile reads.
inline constexpr double kMostBlocksOfStep = 1024.0;
/// The first two neighbours among levels, the coarsest first, that are too far apart for tiles between them; none if no
/// two are. thread: any
[[nodiscard]] std::optional<std::pair<RasterLevel, RasterLevel>> far_levels(const std::vector<RasterLevel>& levels);

/// Remark for a TIFF on a server that states no place and is therefore taken for a whole planet. thread: any
[[nodiscard]] std::string taken_for_planet(const std::string& name);

/// True if coarse tiles of the raster are quick to make: it has overviews down to a small one, none left out, or is
/// small, and its blocks can be read by themselves. thread: any
[[nodiscard]] bool shows_at_once(const RasterInfo& raster);

/// Makes tiles from a raster as they are asked for (warp_source()): from its own overviews, in any coordinate system,
/// from a file or a server. Nothing is stored. The error begins with `where`. thread: any
[[nodiscard]] Result<std::unique_ptr<TileSource>> direct_tiles(std::unique_ptr<RasterSource> raster,
                                                               const RasterPlace& place, const DirectOptions& options,
                                                               const std::string& where);

/// Tiles of a file, and remarks for the user.
struct DirectFile {
  std::unique_ptr<TileSource> tiles;  ///< null: the file must be cut
  std::vector<std::string> remarks{};
};

/// Makes tiles of an opened raster if it shows_at_once(). No tiles for others, which are cut. Blocks. thread: any
[[nodiscard]] Result<DirectFile> open_direct(const PictureFile& picture, const DirectOptions& options);

}  // namespace terrella
