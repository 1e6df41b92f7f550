#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "streaming/georeference/affine.h"
#include "streaming/raster/byte_file.h"

namespace terrella {

/// Path and size of a picture.
struct PictureFile {
  std::filesystem::path path;
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  /// Bytes of a TIFF that is no local file: `path` then is its name, and no files beside it count.
  std::shared_ptr<const ByteFile> bytes = {};
};

/// Statements of a picture and the files beside it about its place, neither judged nor transformed.
struct Georeference {
  std::string source;               ///< origin of the statement: "GeoTIFF tags", "planet.tfw"; several with commas
  std::optional<Affine> transform;  ///< from pixels to the coordinate system; half-pixel offsets are already applied
  std::string crs;                  ///< text for Crs::open(); empty if not stated
  std::string crs_title;            ///< name used in the file; may be empty
  bool gdal_reads_crs = true;       ///< false: the system comes from a .prj, which only Terrella reads
  bool pixel_is_point = false;      ///< the file gives coordinates of pixel centres
  bool has_control_points = false;  ///< used instead of a transform
  bool has_camera_model = false;    ///< RPC coefficients
};

/// Reads the GeoTIFF tags and the files beside the picture; none if they state no place. The error names the file, the
/// damage or contradiction, and a cure. Without `with_crs`, damaged GeoKeys are no error, because the user has named
/// the coordinate system. thread: any
[[nodiscard]] Result<std::optional<Georeference>> read_georeference(const PictureFile& picture, bool with_crs = true);

}  // namespace terrella
