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

/// Where a picture lies whose rows are parallels and whose columns are meridians, evenly spaced.
struct Placement {
  double west_deg = 0.0;   ///< of the first pixel's outer edge
  double north_deg = 0.0;  ///< of the first row's outer edge
  double pixel_width_deg = 0.0;
  double pixel_height_deg = 0.0;  ///< > 0: rows go south
};

/// What a picture says of itself, judged.
struct PlacedPicture {
  std::optional<Georeference> said;    ///< none: nothing
  std::optional<CrsFacts> crs;         ///< none: not said
  std::optional<Placement> placement;  ///< none: not said; every pixel's corner is within 0.01 pixels of PROJ's answer
};

/// Reads what the picture says and places it. The error says what the picture claims, why that is not drawn, and the
/// GDAL command that makes of it a picture which is. thread: any
[[nodiscard]] Result<PlacedPicture> place_picture(const PictureFile& picture);

/// Fails if the picture says that it is of another body (a radius over 1 % from `body`'s), or that its rows count
/// planetocentric latitudes and `latitude` is another. thread: any
[[nodiscard]] Status check_figure(const PictureFile& picture, const PlacedPicture& placed, const Body& body,
                                  LatitudeKind latitude);

/// The options that pictures in a coordinate system need.
struct NeededOptions {
  std::string body{};                      ///< for --body; empty: Earth, which need not be said
  bool centric = false;                    ///< --latitude centric
  [[nodiscard]] std::string text() const;  ///< each option after a blank
};
[[nodiscard]] NeededOptions needed_options(const CrsFacts& crs);

/// What the picture covers; east < west if it crosses ±180°. Within 0.01 pixels of the whole planet it is the whole
/// planet. The error is about what no rectangle says: all longitudes from elsewhere than -180°, or places beyond a
/// pole.
[[nodiscard]] Result<GeoRect> covered_by(const PictureFile& picture, const Placement& placement);

/// The command that makes of a placed picture one whose pixels fit a grid.
[[nodiscard]] std::string resample_command(const PictureFile& picture, const PlacedPicture& placed);

}  // namespace terrella
