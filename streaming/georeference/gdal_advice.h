#pragma once

#include <optional>
#include <string>
#include <vector>

#include "streaming/georeference/georeference.h"

namespace terrella {

/// GDAL command lines that turn a picture into one with a usable place. They write a file
/// beside the picture and can be pasted into a shell. Words in capitals are for the user to fill in. thread: any

/// A rectangle of pixels of one size, in a grid from (-180°, 90°).
struct DegreeGrid {
  double west_deg = -180.0, south_deg = -90.0, east_deg = 180.0, north_deg = 90.0;
  std::int64_t columns = 0, rows = 0;
};

/// Chooses a grid that covers at least the given rectangle, with pixels of about `pixel_deg` that divide 360° evenly.
[[nodiscard]] DegreeGrid grid_over(double west_deg, double south_deg, double east_deg, double north_deg,
                                   double pixel_deg);

/// Parameters of a warp command.
struct WarpAdvice {
  std::string to_crs = "EPSG:4326";
  std::string from_crs{};  ///< empty: GDAL reads it from the picture
};
[[nodiscard]] std::string warp_command(const PictureFile& picture, const WarpAdvice& advice);
/// Command that assigns a coordinate system to a picture, with a code that the user knows.
[[nodiscard]] std::string name_system_command(const PictureFile& picture);
/// Command that joins the parts of a mosaic into one picture beside the first part.
[[nodiscard]] std::string join_command(const std::vector<std::filesystem::path>& parts);
/// Command that assigns a place to a picture, with numbers that the user knows.
[[nodiscard]] std::string assign_command(const PictureFile& picture);
/// Command that makes the picture's own tags win over files beside it.
[[nodiscard]] std::string own_word_command(const PictureFile& picture);

}  // namespace terrella
