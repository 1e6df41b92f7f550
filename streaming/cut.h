#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geo/result.h"
#include "streaming/tile_source.h"

namespace terrella {

struct CutOptions {
  std::vector<std::filesystem::path> images;  ///< one now; several form a mosaic later
  std::filesystem::path output;               ///< *.gpkg: a GeoPackage; else a directory
  int tile_px = 256;
  int quality = 85;
  std::optional<ImageFormat> format;  ///< default: PNG if the picture has transparency, else JPEG
  std::optional<GeoRect> bounds;      ///< default: whole planet, and then the picture must be 2:1
  Projection projection = Projection::equirectangular;
  LatitudeKind latitude = LatitudeKind::graphic;
  std::string name, attribution, body;
  int jobs = 0;  ///< encoders; 0: as many as cores
  /// Called from the calling thread with rows done and rows in all; false asks to stop.
  std::function<bool(std::int64_t done, std::int64_t total)> progress;
};

struct CutSummary {
  TileGrid grid;
  std::int64_t tiles = 0;
  std::int64_t bytes = 0;
};

/// Cuts a picture into a tile set: one streaming pass over its rows (memory does not grow with its height), the
/// source's own pixels at the finest level (root span = tile_px · pixel size · 2^L), coarser levels by weights that are
/// right on the sphere (cos of latitude; wrap at ±180°). The output appears under its name only when it is whole.
[[nodiscard]] Result<CutSummary> cut(const CutOptions& options);

/// The GeoPackage for an image file in the cache directory, cut the first time; found again by path, size and time of
/// change.
[[nodiscard]] Result<std::filesystem::path> cut_into_cache(const CutOptions& options,
                                                           const std::filesystem::path& cache_dir);

}  // namespace terrella
