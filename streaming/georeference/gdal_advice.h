#pragma once

#include <optional>
#include <string>

#include "streaming/georeference/georeference.h"

namespace terrella {

/// Command lines of GDAL that make of a picture one that is placed as it says. They write STEM-degrees.tif beside it
/// and can be given to a shell as they are; words in capitals are for the user to fill in. thread: any

/// A rectangle of pixels of one size, in a grid from (-180°, 90°).
struct DegreeGrid {
  double west_deg = -180.0, south_deg = -90.0, east_deg = 180.0, north_deg = 90.0;
  std::int64_t columns = 0, rows = 0;
};

/// The grid for pixels of about `pixel_deg` whose pixels are a whole part of 360°, over at least the rectangle given.
[[nodiscard]] DegreeGrid grid_over(double west_deg, double south_deg, double east_deg, double north_deg,
                                   double pixel_deg);

/// How the picture is warped.
struct WarpAdvice {
  std::string to_crs = "EPSG:4326";
  std::string from_crs;                  ///< empty: GDAL reads it from the picture
  std::optional<DegreeGrid> grid;        ///< none: GDAL chooses
  std::optional<DegreeGrid> relabelled;  ///< the picture's pixels are of these degrees: say so first, without warping
};
[[nodiscard]] std::string warp_command(const PictureFile& picture, const WarpAdvice& advice);
/// Says where a picture lies, in numbers that the user knows.
[[nodiscard]] std::string assign_command(const PictureFile& picture);
/// Takes the word of the picture's own tags against that of files beside it.
[[nodiscard]] std::string own_word_command(const PictureFile& picture);

}  // namespace terrella
