#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"
#include "codecs/image.h"
#include "streaming/georeference/georeference.h"

namespace terrella {

/// A picture of a map.
struct WrittenPicture {
  const Image& image;
  bool with_alpha = true;  ///< writes the alpha too
};

/// Writes a picture as a cloud-optimized GeoTIFF: tiles, overviews, Deflate without loss. The complete file appears
/// under its name and replaces an earlier one. `to_crs`: from pixels to coordinates of `crs`, easting first; `crs`:
/// text for Crs::open(); `attribution`: its TIFFTAG_COPYRIGHT, or empty. The error names the file. Uses GDAL
/// (load_gdal()). Blocks. thread: any
[[nodiscard]] Status write_geotiff(const std::filesystem::path& path, const WrittenPicture& picture,
                                   const std::string& crs, const Affine& to_crs, const std::string& attribution);

}  // namespace terrella
