#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/affine.h"

namespace terrella {

/// What a file beside a picture says of the picture's place.
struct SideClaim {
  std::filesystem::path file;
  std::optional<Affine> transform;
  std::string crs;  ///< a text for Crs::open(); empty: not said
  bool has_control_points = false;
};

/// Reads the files beside the picture that say where it lies: world files (six numbers: .wld, and of a .tif .tfw and
/// .tifw, likewise of others, in lower, upper and first upper case), GDAL's PICTURE.aux.xml, and a .prj, which counts
/// only beside a world file. Files that say nothing of a place are left out. The error, which has not the
/// picture's name, names the damaged file.
/// thread: any
[[nodiscard]] Result<std::vector<SideClaim>> read_side_files(const std::filesystem::path& picture);

}  // namespace terrella
