#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "streaming/georeference/affine.h"

namespace terrella {

class RasterFile;

/// Path and size of a picture.
struct PictureFile {
  std::filesystem::path path;
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  /// The opened raster; null for JPEG, PNG and WebP. Of a raster that is no local file, `path` is the name.
  std::shared_ptr<const RasterFile> raster = {};
};

/// Statements of a picture and the files beside it about its place, neither judged nor transformed.
struct Georeference {
  std::string source;               ///< origin of the statement: "GeoTIFF tags", "planet.tfw"; several with commas
  std::string fault;                ///< reason why the statement cannot be read; empty: it can
  std::optional<Affine> transform;  ///< from pixels to the coordinate system; half-pixel offsets are already applied
  std::string crs;                  ///< text for Crs::open(); empty if not stated
  std::string crs_title;            ///< name used in the file; may be empty
  bool pixel_is_point = false;      ///< the file gives coordinates of pixel centres
  std::string points;               ///< points by which GDAL resamples it onto the transform; empty: it is a grid
  bool has_control_points = false;  ///< a file beside the picture states them instead of a transform
};

/// Returns what the picture's header and the files beside it say; none if they state no place. The error names the
/// file, the damage or contradiction, and a cure. Without `with_crs`, a system that cannot be read is no error, because
/// the user has named one. thread: any
[[nodiscard]] Result<std::optional<Georeference>> read_georeference(const PictureFile& picture, bool with_crs = true);

}  // namespace terrella
