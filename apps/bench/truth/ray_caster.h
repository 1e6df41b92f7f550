#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "apps/bench/truth/picture.h"
#include "apps/bench/truth/spheroid.h"

namespace terrella::truth {

/// The command line's camera, in degrees and metres. Heading is clockwise from north. Pitch is up from the horizontal;
/// at -90° heading sets the picture's up direction. The field of view is vertical.
struct TruthCamera {
  Place eye{.lat_deg = 0.0, .lon_deg = 0.0, .height_m = 1.0e7};
  double heading_deg = 0.0;
  double pitch_deg = -90.0;
  double fov_deg = 40.0;
};

/// Relation between the source picture's rows and latitude.
struct RowRule {
  bool equal_area = false;  ///< rows linear in the sine (Lambert's cylinder) instead of in the latitude
  bool centric = false;     ///< rows count planetocentric instead of geodetic latitude
};

struct TruthOptions {
  int width = 1024;
  int height = 1024;
  int rays_per_side = 8;  ///< 8: 64 rays a pixel, at the centres of an 8×8 grid; the pixel is a box
  int threads = 2;        ///< the result does not depend on the number
};

/// The unrounded picture of an ideal renderer, and each pixel's place. Arrays run row by row from the top.
struct TruthImage {
  int width = 0;
  int height = 0;
  int rays_per_pixel = 0;
  std::vector<float> rgb;           ///< 3 a pixel, 0…255, mean in gamma-encoded space; rays that miss are black
  std::vector<std::uint16_t> hits;  ///< rays of the pixel that met the body
  std::vector<float> lat_deg;       ///< geodetic, at the pixel's centre; NaN if that ray misses
  std::vector<float> lon_deg;
  std::vector<float>
      incidence_deg;  ///< between the geodetic normal and the direction to the eye; NaN if that ray misses

  [[nodiscard]] bool covered(std::size_t pixel) const { return hits[pixel] == rays_per_pixel; }
};

/// Rays through positions in the picture (pixel centres at halves, y down), not normalised: one unit along the view
/// axis.
class PixelRays {
 public:
  PixelRays(const Spheroid& body, const TruthCamera& camera, int width, int height);
  [[nodiscard]] const glm::dvec3& eye_m() const { return eye_m_; }
  [[nodiscard]] glm::dvec3 direction(const glm::dvec2& pixel) const;

 private:
  glm::dvec3 eye_m_, forward_, right_step_, up_step_;
  glm::dvec2 centre_px_;
};

/// Continuous texel coordinates of a hit: texel centres at halves, x east from -180°, y south from the top row's edge.
[[nodiscard]] glm::dvec2 texel_position(const Picture& source, const RowRule& rows, const Hit& hit);

/// Bilinear look-up, 0…255: wraps at ±180°, clamps to the first and last row.
[[nodiscard]] glm::dvec3 sample(const Picture& source, const glm::dvec2& texel);

/// Casts the picture. 1024×1024 with 64 rays is 67 million rays: about 5 s on two cores.
[[nodiscard]] TruthImage cast(const Picture& source, const RowRule& rows, const Spheroid& body,
                              const TruthCamera& camera, const TruthOptions& options);

}  // namespace terrella::truth
