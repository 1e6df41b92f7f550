#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/result.h"
#include "streaming/georeference/affine.h"

namespace terrella {

/// A picture's file and its size.
struct PictureFile {
  std::filesystem::path path;
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
};

/// What a picture and the files beside it say of its place: as it is said, nothing judged, nothing transformed.
struct Georeference {
  std::string source;               ///< who says it: "GeoTIFF tags", "planet.tfw", several with commas
  std::optional<Affine> transform;  ///< from pixels to the coordinate system; half a pixel is allowed for
  std::string crs;                  ///< a text for Crs::open(); empty: not said
  std::string crs_title;            ///< the file's own name for it; may be empty
  bool gdal_reads_crs = true;       ///< false: only we read it, from a .prj
  bool pixel_is_point = false;      ///< said for the middles of pixels
  bool has_control_points = false;  ///< instead of a transform
  bool has_camera_model = false;    ///< RPC
};

/// Reads the GeoTIFF tags and the files beside the picture; none if they say nothing. The error names the file, what is
/// damaged or contradicts, and what to do. thread: any
[[nodiscard]] Result<std::optional<Georeference>> read_georeference(const PictureFile& picture);

}  // namespace terrella
