#pragma once

#include <compare>
#include <numbers>

namespace terrella {

/// A plane angle, radians inside. It can be made only by naming the unit. degrees() and deg() are exact to 1 ulp each
/// way. Multiples of 90° are exact in degrees, not in radians. thread: any
class Angle {
 public:
  constexpr Angle() = default;
  [[nodiscard]] static constexpr Angle radians(double rad) { return Angle(rad); }
  [[nodiscard]] static constexpr Angle degrees(double deg) { return Angle(deg * (std::numbers::pi / 180.0)); }

  [[nodiscard]] constexpr double rad() const { return rad_; }
  [[nodiscard]] constexpr double deg() const { return rad_ * (180.0 / std::numbers::pi); }

  constexpr auto operator<=>(const Angle&) const = default;
  [[nodiscard]] friend constexpr Angle operator+(Angle a, Angle b) { return Angle(a.rad_ + b.rad_); }
  [[nodiscard]] friend constexpr Angle operator-(Angle a, Angle b) { return Angle(a.rad_ - b.rad_); }
  [[nodiscard]] friend constexpr Angle operator-(Angle a) { return Angle(-a.rad_); }
  [[nodiscard]] friend constexpr Angle operator*(double s, Angle a) { return Angle(s * a.rad_); }
  [[nodiscard]] friend constexpr Angle operator*(Angle a, double s) { return Angle(s * a.rad_); }
  [[nodiscard]] friend constexpr double operator/(Angle a, Angle b) { return a.rad_ / b.rad_; }

 private:
  constexpr explicit Angle(double rad) : rad_(rad) {}
  double rad_ = 0.0;
};

}  // namespace terrella
