#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/crs.h"
#include "streaming/georeference/georeference.h"

namespace terrella {

/// Place of a picture whose rows are parallels and whose columns are meridians, evenly spaced.
struct Placement {
  double west_deg = 0.0;   ///< outer edge of the first pixel
  double north_deg = 0.0;  ///< outer edge of the first row
  double pixel_width_deg = 0.0;
  double pixel_height_deg = 0.0;  ///< > 0: rows go south
};

/// Place of a picture after checking.
struct PlacedPicture {
  std::optional<Georeference> said;    ///< statement of the picture and the files beside it; none: they state nothing
  std::optional<CrsFacts> crs;         ///< system used: the user's, else the picture's; none: not stated
  std::optional<CrsPlace> projected;   ///< place in any system; none: not stated, the picture is a whole planet
  std::optional<Placement> placement;  ///< the same place in even steps of degrees, if it is one: every pixel corner is
                                       ///< within 0.01 pixels of PROJ's result
  std::string claim;                   ///< source of the system: "PATH: its GeoTIFF tags say that it is …"
  std::vector<std::string> remarks;    ///< statements of the picture that the user's words overrule, for the user
};

/// Reads and checks the place that the user and the picture state. The error gives the statement, why the picture
/// cannot be drawn, and the option or GDAL command that helps. thread: any
[[nodiscard]] Result<PlacedPicture> place_picture(const PictureFile& picture, const PlaceWords& words = {});

/// Place that the user's bounds in degrees, or --west, give to a picture. Fails if a picture of a whole planet is not
/// 2:1. thread: any
[[nodiscard]] Result<Placement> place_of_words(const PictureFile& picture, const PlaceWords& words);

}  // namespace terrella
