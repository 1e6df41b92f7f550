#pragma once

#include <optional>

#include "geo/coordinates.h"

namespace terrella {

/// An oblate ellipsoid of revolution, or a sphere: semi-major axis a, flattening f. Domain: a in [1 m, 1e10 m], f in
/// [0, 0.5). thread: any
class Ellipsoid {
 public:
  Ellipsoid(double a_m, double f) : a_m_(a_m), f_(f) {}

  [[nodiscard]] double a_m() const { return a_m_; }
  [[nodiscard]] double f() const { return f_; }
  [[nodiscard]] double b_m() const { return a_m_ * (1.0 - f_); }  ///< semi-minor (polar) axis
  [[nodiscard]] double e2() const { return f_ * (2.0 - f_); }     ///< first eccentricity squared
  [[nodiscard]] double one_minus_e2() const { return (1.0 - f_) * (1.0 - f_); }

  /// Prime-vertical radius of curvature N = a / sqrt(1 - e² n_z²), n_z being the z of the unit normal.
  [[nodiscard]] double prime_vertical_radius_m(double n_z) const;

  /// Returns the position at `height_m` over the surface point whose geodetic normal is n: (N n_x, N n_y, N(1-e²) n_z)
  /// + h n (engine/DESIGN.md, 1).
  [[nodiscard]] Ecef position(const EcefDir& normal, double height_m = 0.0) const;

  [[nodiscard]] Ecef to_ecef(const Geodetic& place) const;
  /// Returns geodetic coordinates; error ≤ 10 nm within 5000 km of the surface (GeographicLib::Geocentric, Karney
  /// 2011). On the axis the longitude is 0. At the centre the result is the nearest surface point on the north polar
  /// axis.
  [[nodiscard]] Geodetic to_geodetic(const Ecef& p) const;

  /// Returns the unit geodetic normal at a latitude and longitude. Exact at the poles: |lat| = 90° gives (0, 0, ±1) to
  /// 1 ulp.
  [[nodiscard]] static EcefDir normal(Angle lat, Angle lon);
  /// Returns latitude and longitude of a unit normal, by atan2, which unlike asin is accurate at the poles.
  [[nodiscard]] static Geodetic lat_lon(const EcefDir& normal);
  /// Returns the geodetic normal at a point *on the surface*: normalised (x, y, z/(1-e²)).
  [[nodiscard]] EcefDir surface_normal(const Ecef& on_surface) const;

  /// Returns the distance along a ray from `origin` to the nearest crossing in front, metres; nothing if the ray
  /// misses. From inside the body, the far crossing. Stable at grazing incidence (Hearn & Baker's form of the
  /// discriminant).
  [[nodiscard]] std::optional<double> intersect_m(const Ecef& origin, const EcefDir& direction) const;

 private:
  double a_m_;
  double f_;
};

}  // namespace terrella
