#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"

namespace terrella {

/// A point in a coordinate reference system, or longitude and latitude.
struct CrsPoint {
  double x = 0.0;
  double y = 0.0;
};

/// Transform from pixel coordinates to map coordinates. Pixel coordinates begin at the outer corner of the first pixel,
/// x to the right and y down, so the middle of the first pixel is (0.5, 0.5).
struct Affine {
  double x0 = 0.0, x_per_column = 1.0, x_per_row = 0.0;
  double y0 = 0.0, y_per_column = 0.0, y_per_row = -1.0;

  [[nodiscard]] CrsPoint at(double column, double row) const {
    return {x0 + x_per_column * column + x_per_row * row, y0 + y_per_column * column + y_per_row * row};
  }
  /// Converts a transform given for the middle of the first pixel.
  [[nodiscard]] Affine from_centre() const {
    Affine corner = *this;
    corner.x0 -= 0.5 * (x_per_column + x_per_row);
    corner.y0 -= 0.5 * (y_per_column + y_per_row);
    return corner;
  }
  [[nodiscard]] bool is_finite() const {
    bool finite = true;
    for (const double value : {x0, x_per_column, x_per_row, y0, y_per_column, y_per_row}) {
      finite = finite && std::isfinite(value) && std::abs(value) < 1e15;
    }
    return finite && std::abs(x_per_column * y_per_row - x_per_row * y_per_column) > 1e-30;
  }
  [[nodiscard]] bool is_turned() const { return x_per_row != 0.0 || y_per_column != 0.0; }
};

/// Place of a picture: the transform of its pixels to a coordinate system that PROJ knows.
struct CrsPlace {
  Affine to_crs;    ///< transform of the full-size picture, pixel-is-area
  std::string crs;  ///< text for Crs::open()
};

class RasterFile;

/// Path and size of a picture.
struct PictureFile {
  std::filesystem::path path;
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  /// The opened raster; null for JPEG, PNG and WebP. Of a raster that is no local file, `path` is the name.
  std::shared_ptr<const RasterFile> raster = {};
};

/// Statements of a picture and the files beside it about its place, neither judged nor transformed.
struct Georeference {
  std::string source;               ///< origin of the statement: "GeoTIFF tags", "planet.tfw"; several with commas
  std::string fault;                ///< reason why the statement cannot be read; empty: it can
  std::optional<Affine> transform;  ///< from pixels to the coordinate system; half-pixel offsets are already applied
  std::string crs;                  ///< text for Crs::open(); empty if not stated
  std::string crs_title;            ///< name used in the file; may be empty
  bool pixel_is_point = false;      ///< the file gives coordinates of pixel centres
  std::string points;               ///< points by which GDAL resamples it onto the transform; empty: it is a grid
  bool has_control_points = false;  ///< a file beside the picture states them instead of a transform
};

/// Returns what the picture's header and the files beside it say; none if they state no place. The error names the
/// file, the damage or contradiction, and a cure. Without `with_crs`, a system that cannot be read is no error, because
/// the user has named one. thread: any
[[nodiscard]] Result<std::optional<Georeference>> read_georeference(const PictureFile& picture, bool with_crs = true);

/// A rectangle in units of a coordinate system.
struct CrsBounds {
  double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
  bool operator==(const CrsBounds&) const = default;
};

/// The user's statements about a picture's place. Each replaces the statement of the picture and the files beside it.
struct PlaceWords {
  std::string crs{};                  ///< text for Crs::open()
  std::optional<CrsBounds> bounds{};  ///< in units of `crs`; in degrees without `crs`, where east < west crosses ±180°
  std::optional<double> west_deg{};   ///< the picture is a whole planet from this longitude on; excludes `bounds`

  [[nodiscard]] bool say_place() const { return bounds || west_deg; }
  bool operator==(const PlaceWords&) const = default;
};

}  // namespace terrella
