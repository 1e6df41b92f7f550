#pragma once

#include <glm/vec3.hpp>
#include <optional>

namespace terrella::truth {

/// An ellipsoid of revolution about z: semi-major axis and flattening (WGS84: 6378137 m, 1/298.257223563). Earth-fixed
/// frame: +x 0°N 0°E, +z the north pole, metres. The ground truth has its own mathematics in double and shares no code
/// with its subjects.
struct Spheroid {
  double a_m = 6378137.0;
  double f = 1.0 / 298.257223563;
  [[nodiscard]] double b_m() const { return a_m * (1.0 - f); }
};

/// A place in degrees and metres; geodetic latitude. Longitude in [-180°, 180°].
struct Place {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double height_m = 0.0;
};

/// East, north and up at a place. At a pole the longitude defines north, as on the meridian just before the pole.
struct LocalFrame {
  glm::dvec3 east, north, up;
};
[[nodiscard]] LocalFrame local_frame(double lat_deg, double lon_deg);

/// Earth-fixed position of a place. Error: a few ulp of the radius.
[[nodiscard]] glm::dvec3 position_m(const Spheroid& body, const Place& place);

/// First intersection of a ray with the surface.
struct Hit {
  glm::dvec3 position_m;
  glm::dvec3 normal;  ///< geodetic, unit, outward
  double distance;    ///< along the ray, in units of the direction's length; > 0
};

/// Returns the first point in front of the eye; from inside, the far wall. Returns nullopt if the ray misses. The
/// discriminant uses the ray's closest point to the centre, so that a far eye loses no digits at the limb.
[[nodiscard]] std::optional<Hit> first_hit(const Spheroid& body, const glm::dvec3& eye_m, const glm::dvec3& direction);

/// Geodetic latitude and longitude of a geodetic normal, radians; accurate at the poles.
[[nodiscard]] double latitude_rad(const glm::dvec3& normal);
[[nodiscard]] double longitude_rad(const glm::dvec3& normal);

}  // namespace terrella::truth
