#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/georeference.h"

namespace terrella {

/// Statement of a file beside a picture about the picture's place.
struct SideClaim {
  std::filesystem::path file;
  std::optional<Affine> transform;
  std::string crs;  ///< text for Crs::open(); empty if not stated
  bool has_control_points = false;
};

/// Reads the files beside the picture that give its place. Skips files without a place. The error names the damaged
/// file, but not the picture. thread: any
/// - World files with six numbers: .wld, and for a .tif also .tfw and .tifw (likewise for other endings), in lower,
///   upper and capitalised case.
/// - GDAL's PICTURE.aux.xml.
/// - A .prj, which counts only beside a world file.
[[nodiscard]] Result<std::vector<SideClaim>> read_side_files(const std::filesystem::path& picture);

/// True if a file beside the picture places its stored rows, as a world file does. GDAL and other writers of such files
/// ignore orientations. False if such a file is damaged. thread: any
[[nodiscard]] bool is_placed_as_stored(const std::filesystem::path& picture);

}  // namespace terrella
