#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Parts of a picture in order, rows from the north-west.
struct MosaicGrid {
  int columns = 1;
  int rows = 1;
};

/// Heights instead of colours. For pictures of whole numbers `scale` and `offset` say what a number means (metres =
/// number · scale + offset; default: metres) and tiles keep the numbers. 32-bit floats are metres, and the two say how
/// tiles keep them; default: so that 65535 numbers span all heights.
struct CutElevation {
  std::optional<double> scale = {};
  std::optional<double> offset = {};
  std::optional<double> nodata = {};  ///< the value in the picture that says that there is no height; NaN always does
};

/// One of `count` machines that cut the same picture.
struct CutShard {
  int index = 1;  ///< from 1
  int count = 1;
};

struct CutOptions {
  std::vector<std::filesystem::path> images{};  ///< several are the parts of one picture (streaming/cut/README.md)
  std::filesystem::path output{};               ///< *.gpkg: a GeoPackage; else a directory
  int tile_px = 256;
  int quality = 85;
  std::optional<ImageFormat> format{};  ///< default: PNG if the picture has transparency, else JPEG
  std::optional<MosaicGrid> mosaic = {};
  std::optional<CutElevation> elevation = {};
  /// Default: what the picture says of itself (streaming/georeference), else the whole planet, and then it must be 2:1.
  /// East < west crosses ±180°.
  std::optional<GeoRect> bounds{};
  Projection projection = Projection::equirectangular;
  LatitudeKind latitude = LatitudeKind::graphic;
  std::string name{}, attribution{}, body{};
  int jobs = 0;                        ///< encoders; 0: as many as cores
  std::optional<CutShard> shard = {};  ///< cut that part alone, into OUTPUT.shard-I-of-N
  bool join = false;                   ///< make the output of the shards that lie beside it
  bool force = false;                  ///< replaces a tile set that was cut from other pictures, too
  /// Called from the calling thread with rows done and rows in all; false asks to stop.
  std::function<bool(std::int64_t done, std::int64_t total)> progress{};
};

struct CutSummary {
  TileGrid grid;
  std::int64_t tiles = 0;
  std::int64_t bytes = 0;
};

/// Cuts a picture into a tile set, or, with `shard`, does a part of the work: one streaming pass over its rows (memory
/// does not grow with its height), the source's own pixels at the finest level (root span = tile_px · pixel size ·
/// 2^L), coarser levels by weights that are right on the sphere (cos of latitude; wrap at ±180°). The output appears
/// under its name only when it is whole. It replaces nothing but an earlier output of cut() (streaming/cut/README.md,
/// "Replacing an output"). What a killed run has left is gone on with if options and pictures are the
/// same; the result is the same bytes. Blocks. thread: any
[[nodiscard]] Result<CutSummary> cut(const CutOptions& options);

/// Fails as cut() would before it reads a pixel; looks at the pictures alone, not at the output. Blocks.
/// thread: any
[[nodiscard]] Status check_pictures(const CutOptions& options);

/// The GeoPackage for an image file in the cache directory, cut the first time; found again by path, size and time of
/// change. Blocks. thread: any
[[nodiscard]] Result<std::filesystem::path> cut_into_cache(const CutOptions& options,
                                                           const std::filesystem::path& cache_dir);

}  // namespace terrella
