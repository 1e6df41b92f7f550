#pragma once

#include <optional>

#include "geo/coordinates.h"

namespace terrella {

/// An oblate ellipsoid of revolution (or sphere): semi-major axis a, flattening f.
/// Domain: a in [1 m, 1e10 m], f in [0, 0.5). thread: any
class Ellipsoid {
 public:
  Ellipsoid(double a_m, double f) : a_m_(a_m), f_(f) {}

  [[nodiscard]] double a_m() const { return a_m_; }
  [[nodiscard]] double f() const { return f_; }
  [[nodiscard]] double b_m() const { return a_m_ * (1.0 - f_); }  ///< semi-minor (polar) axis
  [[nodiscard]] double e2() const { return f_ * (2.0 - f_); }     ///< first eccentricity squared
  [[nodiscard]] double one_minus_e2() const { return (1.0 - f_) * (1.0 - f_); }

  /// Prime-vertical radius of curvature N = a / sqrt(1 - e² n_z²) for a unit normal with that z.
  [[nodiscard]] double prime_vertical_radius_m(double n_z) const;

  /// The position at `height_m` over the surface point whose geodetic normal is n:
  /// (N n_x, N n_y, N(1-e²) n_z) + h n (engine/DESIGN.md, 1).
  [[nodiscard]] Ecef position(const EcefDir& normal, double height_m = 0.0) const;

  [[nodiscard]] Ecef to_ecef(const Geodetic& place) const;
  /// Geodetic coordinates; error ≤ 10 nm within 5000 km of the surface (GeographicLib::Geocentric, Karney 2011).
  /// On the axis longitude is 0; at the centre the answer is the nearest surface point on the north polar axis.
  [[nodiscard]] Geodetic to_geodetic(const Ecef& p) const;

  /// Unit geodetic normal of a latitude and longitude. Exact at poles: |lat| = 90° gives (0, 0, ±1) to 1 ulp.
  [[nodiscard]] static EcefDir normal(Angle lat, Angle lon);
  /// Latitude and longitude of a unit normal by atan2 (accurate at the pole, where asin is not).
  [[nodiscard]] static Geodetic lat_lon(const EcefDir& normal);
  /// The geodetic normal at a point *on the surface*: normalised (x, y, z/(1-e²)).
  [[nodiscard]] EcefDir surface_normal(const Ecef& on_surface) const;

  /// Distance along a ray from `origin` to the surface, nearest crossing in front, metres; nothing if it misses.
  /// From inside, the far crossing. Stable at grazing incidence (Hearn & Baker's form of the discriminant).
  [[nodiscard]] std::optional<double> intersect_m(const Ecef& origin, const EcefDir& direction) const;

 private:
  double a_m_;
  double f_;
};

}  // namespace terrella
