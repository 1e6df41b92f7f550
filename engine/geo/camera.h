#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string_view>

#include "base/result.h"
#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

// thread: any, for all of this header
namespace terrella {

/// Where the eye is and which way it looks; the command line's camera.
/// heading clockwise from north; pitch up from the horizontal: -90° straight down, and then heading says which way
/// is up in the picture.
struct Camera {
  Geodetic eye{.lat = {}, .lon = {}, .height_m = 1.0e7};
  Angle heading{};
  Angle pitch = Angle::degrees(-90.0);
  Angle fov_y = Angle::degrees(40.0);  ///< vertical field of view, (0°, 170°]
  bool operator==(const Camera&) const = default;
};

/// Reads "LAT,LON,ALT[,HEADING[,PITCH[,FOV]]]" in degrees and metres. Refuses what is not finite, |LAT| > 90, |PITCH| >
/// 90, FOV outside [0.01, 170], ALT outside ±1e12; the error names the field.
[[nodiscard]] Result<Camera> parse_camera(std::string_view text);

/// Picture size in pixels, each ≥ 1.
struct Viewport {
  int width_px = 1;
  int height_px = 1;
  bool operator==(const Viewport&) const = default;
};

/// A camera bound to a body and a picture size, in double: what selection, picking and drawing share.
struct View {
  Ecef eye;
  glm::dvec3 right, up, forward;  ///< orthonormal, ECEF axes
  double tan_half_fov_y;
  Viewport viewport;
  double shear_x = 0.0;       ///< off-axis: the slope, right of forward, that the picture's centre looks along
  double eye_spread_m = 0.0;  ///< two eyes stand this far to its right and left; selection serves both
  [[nodiscard]] double aspect() const { return double(viewport.width_px) / double(viewport.height_px); }
  /// Pixels that one radian covers at the picture's centre.
  [[nodiscard]] double pixels_per_radian() const { return 0.5 * viewport.height_px / tan_half_fov_y; }
};
[[nodiscard]] View make_view(const Camera& camera, const Ellipsoid& ellipsoid, Viewport viewport);

/// view_from_ecef without its translation (the eye is subtracted in double first); an off-axis view's shear is in it,
/// so that it is no rotation there, and what projects needs to know nothing of it.
[[nodiscard]] glm::dmat3 view_from_ecef_rotation(const View& view);
/// Direction through a pixel position (centres at halves), unit, ECEF axes.
[[nodiscard]] EcefDir pixel_ray(const View& view, glm::dvec2 pixel_px);
/// The pixel position of a point; nothing if it is at or behind the eye plane.
[[nodiscard]] std::optional<glm::dvec2> project(const View& view, const Ecef& p);
/// The surface point under a pixel, height 0; nothing beside the globe. From inside: the far wall.
[[nodiscard]] std::optional<Geodetic> pick(const View& view, const Ellipsoid& ellipsoid, glm::dvec2 pixel_px);

}  // namespace terrella
