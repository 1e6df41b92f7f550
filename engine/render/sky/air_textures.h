#pragma once

#include <future>
#include <glm/mat3x3.hpp>
#include <memory>
#include <optional>

#include "geo/body.h"
#include "geo/camera.h"
#include "render/gl/gl_handle.h"
#include "sky/air_colors.h"
#include "sky/air_tables.h"
#include "sky/almanac.h"

namespace terrella {

/// The air as one eye sees it, in textures for the sky, the limb and the ground. Space is scaled so that the body is a
/// sphere of radius 1; the axes of the horizon are x towards the Sun's azimuth and z up. thread: main
class AirTextures {
 public:
  /// `tables` are those of `air`; fit() waits for them.
  AirTextures(const Body& body, const Atmosphere& air, std::shared_future<AirTables> tables);

  /// Computes the air again if the eye, the Sun or the depth of the ground under the ellipsoid has changed. Small
  /// changes count only if `exact`. False if the eye is at the planet's centre.
  bool fit(const View& view, const EcefDir& sun, double below_m, bool exact);
  /// True if fit() has left out a small change since begin_frame().
  [[nodiscard]] bool is_rounded() const { return rounded_; }
  void begin_frame() { rounded_ = false; }

  [[nodiscard]] const Atmosphere& air() const { return air_; }
  [[nodiscard]] const SkyColors& sky() const { return sky_; }
  /// Turns a direction or an offset from the eye, metres, into the axes of the horizon, in scaled space.
  [[nodiscard]] glm::dmat3 horizon_from_ecef() const;
  [[nodiscard]] glm::dmat3 ecef_from_horizon() const;  ///< for directions, of any length
  [[nodiscard]] double eye_radius() const { return eye_.radius; }
  [[nodiscard]] double limb_pixel() const { return pixel_; }  ///< height over the limb that a pixel covers, in radii

  /// True if triangles of the ground may be as large as the eye's height: fragments then compute their distance.
  [[nodiscard]] bool near_ground() const;

  void bind_sky() const;     ///< textures 0 and 1: colours; rows
  void bind_limb() const;    ///< textures 2 and 3: sums of light; sums of the part that passes
  void bind_ground() const;  ///< textures 7 and 8: part that passes; light

 private:
  void upload();
  [[nodiscard]] const AirTables& tables() const { return tables_.get(); }

  Body body_;
  Atmosphere air_;
  std::shared_future<AirTables> tables_;  ///< the same for all eyes
  AirEye eye_{.radius = 0.0};
  double pixel_ = 0.0;
  double below_ = 0.0;  ///< depth of the ground at the limb, in radii
  bool rounded_ = false;
  glm::dmat3 axes_{1.0};
  SkyColors sky_;
  gl::Texture sky_light_, sky_rows_, limb_light_, limb_through_, ground_through_, ground_light_;
};

/// Cosine of the Sun's distance from the zenith of an eye, in scaled space. thread: any
[[nodiscard]] double sun_cosine(const Body& body, const View& view, const EcefDir& sun);

}  // namespace terrella
