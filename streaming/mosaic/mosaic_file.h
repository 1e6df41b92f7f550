#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/georeference.h"
#include "streaming/raster/open_raster.h"

namespace terrella {

/// Functions that measure and open the files of a mosaic. The defaults read all by GDAL.
struct MosaicReading {
  /// Opens a picture; reads the header alone.
  std::function<Result<PictureFile>(const std::filesystem::path&)> measure = measure_raster;
  std::function<Result<std::unique_ptr<RasterSource>>(const std::filesystem::path&, const CrsPlace&,
                                                      const RasterOptions&)>
      open = open_raster;
};

/// Facts from the header of a file. They are kept in the cache, so that a second start opens no file.
struct MosaicFile {
  std::filesystem::path path;
  std::shared_ptr<const RasterFile> raster = {};  ///< the opened file while its place is read; null for plain pictures
  std::int64_t bytes = 0;
  std::int64_t changed_ns = 0;                               ///< time of the last change, nanoseconds since 1970
  std::vector<std::pair<std::int64_t, std::int64_t>> sizes;  ///< sizes of the levels, pixels, the coarsest first
  CrsPlace place;
  bool is_numbers = false;  ///< one band of other than 8 bits; shown as numbers by default
  bool one_band = false;    ///< can be read as numbers
  bool by_rows = false;     ///< has no tiles: the whole level is decoded when it is first needed
  std::string unit;
  double scale = 1.0, offset = 0.0;   ///< value = stored number · scale + offset
  std::optional<double> nodata = {};  ///< replaces the file's own
  std::optional<double> own_nodata = {};

  [[nodiscard]] std::int64_t width_px() const { return sizes.back().first; }
  [[nodiscard]] std::int64_t height_px() const { return sizes.back().second; }
};

/// Reads a file's header; `file` has its path. The place is not read. The error names the file. Blocks. thread: any
[[nodiscard]] Status read_header(MosaicFile& file, const MosaicReading& reading);

/// Sets size and time of a file; fails if it is no regular file. Blocks. thread: any
[[nodiscard]] Status look_at(MosaicFile& file);

}  // namespace terrella
