#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/result.h"
#include "geo/body.h"
#include "geo/coordinates.h"
#include "streaming/georeference/crs.h"
#include "streaming/georeference/georeference.h"
#include "tiles/tile_grid.h"

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
  std::optional<Georeference> said;    ///< none: the picture states nothing
  std::optional<CrsFacts> crs;         ///< none: not stated
  std::optional<Placement> placement;  ///< none: not stated; every pixel corner is within 0.01 pixels of PROJ's result
};

/// Reads and checks the place that the picture states. The error gives the statement, why the picture cannot be drawn,
/// and the GDAL command that converts it. thread: any
[[nodiscard]] Result<PlacedPicture> place_picture(const PictureFile& picture);

/// Fails if the picture states another body (a radius over 1 % from `body`'s). Also fails if its rows count
/// planetocentric latitudes and `latitude` differs. thread: any
[[nodiscard]] Status check_figure(const PictureFile& picture, const PlacedPicture& placed, const Body& body,
                                  LatitudeKind latitude);

/// Options that pictures in a coordinate system need.
struct NeededOptions {
  std::string body{};                      ///< for --body; empty for Earth, the default
  bool centric = false;                    ///< adds --latitude centric
  [[nodiscard]] std::string text() const;  ///< each option after a space
};
[[nodiscard]] NeededOptions needed_options(const CrsFacts& crs);

/// Area of the picture; east < west if it crosses ±180°. An area within 0.01 pixels of the whole planet becomes the
/// whole planet. Fails if no rectangle describes the area: all longitudes from another start than -180°, or places
/// beyond a pole.
[[nodiscard]] Result<GeoRect> covered_by(const PictureFile& picture, const Placement& placement);

/// Command that resamples a placed picture to pixels that fit a grid.
[[nodiscard]] std::string resample_command(const PictureFile& picture, const PlacedPicture& placed);

}  // namespace terrella
