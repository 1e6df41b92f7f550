#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

// thread: any, for all of this header
namespace terrella {

/// The eye's place and its direction of view, as the command line gives them. The heading is clockwise from north. The
/// pitch is upward from the horizontal. At pitch -90°, straight down, the heading is the upward direction in the
/// picture. The functions of this header are pure. thread: any
struct Camera {
  Geodetic eye{.lat = {}, .lon = {}, .height_m = 1.0e7};
  Angle heading{};                      ///< any finite number of turns
  Angle pitch = Angle::degrees(-90.0);  ///< [-90°, 90°]
  Angle fov_y = Angle::degrees(40.0);   ///< vertical field of view, (0°, 170°]
  bool operator==(const Camera&) const = default;
};

/// Reads "LAT,LON,ALT[,HEADING[,PITCH[,FOV]]]" in degrees and metres. The place may also be written as people do,
/// "30N,20E,1000km". Refuses values that are not finite, |LAT| > 90,
/// |PITCH| > 90, FOV outside [0.01, 170], ALT outside ±1e12, LON and HEADING outside ±1e6. The error names the field.
[[nodiscard]] Result<Camera> parse_camera(std::string_view text);
/// Writes a camera as "LAT,LON,ALT,HEADING,PITCH,FOV". parse_camera() reads the same camera to the last bits, and a
/// camera of nameable() exactly.
[[nodiscard]] std::string camera_text(const Camera& camera);
/// The camera whose angles are those of double numbers of degrees, at most a few units in the last place away (some
/// nanometres on the ground). A picture of it is the picture of its text, bit for bit.
[[nodiscard]] Camera nameable(const Camera& camera);

/// Picture size in pixels, each ≥ 1; make_view() takes smaller ones for 1.
struct Viewport {
  int width_px = 1;
  int height_px = 1;
  bool operator==(const Viewport&) const = default;
};

/// A camera combined with a body and a picture size, in double. Selection, picking and drawing all use this value.
struct View {
  Ecef eye;
  glm::dvec3 right, up, forward;  ///< orthonormal, ECEF axes
  double tan_half_fov_y;
  Viewport viewport;
  /// Slope, to the right of forward, of the ray through the picture's centre; 0 unless the view is off-axis.
  double shear_x = 0.0;
  /// Distance of each of two eyes from `eye`, to its left and right; selection serves both eyes.
  double eye_spread_m = 0.0;
  [[nodiscard]] double aspect() const { return double(viewport.width_px) / double(viewport.height_px); }
  /// Pixels that one radian covers at the picture's centre.
  [[nodiscard]] double pixels_per_radian() const { return 0.5 * viewport.height_px / tan_half_fov_y; }
};
[[nodiscard]] View make_view(const Camera& camera, const Ellipsoid& ellipsoid, Viewport viewport);

/// view_from_ecef without its translation: the eye is subtracted in double beforehand. The matrix contains the shear of
/// an off-axis view, and then is not a rotation. Code that projects does not have to treat that case.
[[nodiscard]] glm::dmat3 view_from_ecef_rotation(const View& view);
/// Returns the unit direction through a pixel position (pixel centres at halves), ECEF axes.
[[nodiscard]] EcefDir pixel_ray(const View& view, glm::dvec2 pixel_px);
/// Returns the pixel position of a point; nothing if the point is at or behind the eye's plane.
[[nodiscard]] std::optional<glm::dvec2> project(const View& view, const Ecef& p);
/// Returns the surface point under a pixel, at height 0; nothing if the pixel shows no part of the globe. From inside
/// the body, the point is on the far wall.
[[nodiscard]] std::optional<Geodetic> pick(const View& view, const Ellipsoid& ellipsoid, glm::dvec2 pixel_px);

}  // namespace terrella
