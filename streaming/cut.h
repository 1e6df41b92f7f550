#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/georeference.h"
#include "streaming/numbers/stretch_rule.h"
#include "streaming/raster/open_raster.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Arrangement of the parts of one picture. Parts are given in rows from the north-west.
struct MosaicGrid {
  int columns = 1;  ///< [1, 100000]
  int rows = 1;     ///< [1, 100000]
};

/// Makes the cut treat the picture as heights instead of colours.
/// Floats of a CutRaster without `scale` and `offset` stay floats, because their range would need a second reading.
/// Pictures of whole numbers: `scale` and `offset` give their meaning, metres = number · scale + offset (default:
/// metres). Tiles keep the numbers.
/// 32-bit floats are metres: `scale` and `offset` define how tiles store them. By default 65535 numbers span all
/// heights.
struct CutElevation {
  std::optional<double> scale = {};   ///< [-1e9, 1e9], not 0
  std::optional<double> offset = {};  ///< [-1e9, 1e9]
  std::optional<double> nodata = {};  ///< picture value that means "no height"; NaN always does
};

/// Makes the cut keep the numbers of one band (streaming/cut/README.md, "Numbers").
struct CutNumbers {
  int band = 1;                       ///< counted from 1, [1, 65535]
  std::optional<double> nodata = {};  ///< value that means "no data"; default: as stated by the picture
};

/// Makes the cut show three bands as red, green and blue, each stretched by itself (8-bit tiles).
struct CutBands {
  std::array<int, 3> bands{1, 2, 3};                    ///< counted from 1, [1, 65535]
  std::array<std::optional<StretchRule>, 3> stretch{};  ///< none: 8 bits as they are, else percent:2,98
  std::optional<double> nodata = {};                    ///< transparent where all three bands have it
};
/// The same bands as a raster's reader takes them. thread: any
[[nodiscard]] BandComposite composite_of(const CutBands& bands);

/// One of `count` machines that cut the same picture together.
struct CutShard {
  int index = 1;  ///< [1, count]
  int count = 1;  ///< [1, 100000]
};

/// A picture that is no local file, such as a raster on a server. CutOptions::picture has its head.
struct CutRaster {
  std::string key;  ///< differs if the pixels may differ
  /// Opens the raster. Its blocks are read as those of a local one.
  std::function<Result<std::unique_ptr<RasterSource>>(const CrsPlace& place, const RasterOptions& options)> open;
};

/// Place of an encoded tile in a file of unfinished work. The file may get the name without ".part" at any time.
struct CutTile {
  TileId id;
  std::filesystem::path log;  ///< without ".part"
  std::uint64_t offset = 0;   ///< bytes
  std::size_t size = 0;       ///< bytes
};

/// Receives the results of a cut while it goes on. Tiles of the coarsest levels are not among them, because they are
/// made at the end.
struct CutWatch {
  /// thread: a thread of the cut, one at a time
  std::function<void(const CutTile& tile)> tile_made;
  /// Row of the picture on its grid, as RGBA8, for every row_step-th row. thread: the cut's
  std::function<void(std::int64_t row, std::span<const std::uint8_t> rgba)> row_read;
  std::int64_t row_step = 1;  ///< positive
};

/// Grid of the tiles that a cut makes.
enum class CutGrid {
  geodetic,     ///< the picture's own pixels
  web_mercator  ///< EPSG:3857, the picture is resampled (streaming/cut/README.md, "Web Mercator")
};

struct CutOptions {
  std::vector<std::filesystem::path> images{};  ///< several files are parts of one picture (streaming/cut/README.md)
  std::optional<PictureFile> picture = {};      ///< the one file of `images`, if it is open already
  std::optional<CutRaster> raster = {};         ///< replaces the file; `images` then contains its name alone
  /// *.gpkg makes a GeoPackage, in Web Mercator also *.mbtiles and *.pmtiles, any other name a directory.
  std::filesystem::path output{};
  CutGrid grid = CutGrid::geodetic;
  int tile_px = 256;                    ///< even, [16, 4096]; at most 1024 in Web Mercator
  int quality = 85;                     ///< [1, 100]
  std::optional<ImageFormat> format{};  ///< default: PNG if the picture has transparency inside, else JPEG with PNG at
                                        ///< the outline (MBTiles: PNG)
  std::optional<MosaicGrid> mosaic = {};
  std::optional<CutElevation> elevation = {};
  std::optional<CutNumbers> numbers = {};  ///< at most one of `elevation`, `numbers` and `composite` is set
  std::optional<CutBands> composite = {};
  /// Area of the picture in degrees. East < west crosses ±180°. Default: the place stated by the picture itself
  /// (streaming/georeference). Without one the picture is the whole planet and must be 2:1.
  std::optional<GeoRect> bounds{};
  std::string crs{};                         ///< the picture's coordinate system, any text for PROJ; default: as stated
  std::optional<CrsBounds> crs_bounds = {};  ///< instead of `bounds`: in units of `crs`, or degrees without `crs`
  std::optional<double> west_deg = {};       ///< a picture of the whole planet begins at this longitude, [-360, 360]
  Projection projection = Projection::equirectangular;  ///< or equal_area
  std::optional<LatitudeKind> latitude = {};  ///< counted by the rows; default: as the picture states, else graphic
  std::string name{}, attribution{}, body{};
  int jobs = 0;                        ///< number of encoder threads, [0, 256]; 0: one for each core
  std::optional<CutShard> shard = {};  ///< cuts only this part, into OUTPUT.shard-I-of-N
  bool join = false;                   ///< builds the output from the finished shards beside it
  bool keep_shards = false;            ///< `join` leaves the shards, so that it may run again
  bool force = false;                  ///< also replaces a tile set that was cut from other pictures
  /// Called on the calling thread with the rows done and the total rows. Returning false stops the cut.
  std::function<bool(std::int64_t done, std::int64_t total)> progress{};
  bool keep_unfinished = false;     ///< keeps finished work for the next run if `progress` stops the cut
  std::optional<CutWatch> watch{};  ///< for pictures of colours, in a geodetic grid
  /// Receives remarks for the user on the calling thread: statements of the picture that these options overrule.
  std::function<void(const std::string& remark)> remark{};
};

struct CutSummary {
  TileGrid grid;
  std::int64_t tiles = 0;
  std::int64_t bytes = 0;
  int left_out = 0;  ///< files of a folder or list that could not be read; CutOptions::remark has named them
};

/// Cuts a picture into a tile set, or, with `shard`, does a part of the work. One streaming pass reads the rows, so
/// memory does not grow with the picture's height. The finest level has the source's own pixels (root span = tile_px ·
/// pixel size · 2^L), unless `grid` says another. Coarser levels are means by area on the sphere, also across ±180°.
/// The output appears under its name only when it is complete. It replaces nothing but an earlier output of cut()
/// (streaming/cut/README.md, "Replacing an output"). A cut with the same options and pictures continues the work of a
/// killed cut; the result is the same bytes. Blocks. thread: any
[[nodiscard]] Result<CutSummary> cut(const CutOptions& options);

/// Fails as cut() would before it reads a pixel; looks at the pictures alone, not at the output. Blocks.
/// thread: any
[[nodiscard]] Status check_pictures(const CutOptions& options);

/// Name of the GeoPackage for an image file in the cache directory. thread: any
[[nodiscard]] Result<std::filesystem::path> cache_path(const CutOptions& options,
                                                       const std::filesystem::path& cache_dir);

/// Returns the GeoPackage for an image file in the cache directory, and cuts it the first time. Path, size, time of
/// change and place identify the file. Blocks. thread: any
[[nodiscard]] Result<std::filesystem::path> cut_into_cache(const CutOptions& options,
                                                           const std::filesystem::path& cache_dir);

}  // namespace terrella
