#pragma once

#include <chrono>

#include "geo/camera.h"

// thread: any, for all of this header
namespace terrella {

using Seconds = std::chrono::duration<double>;

/// A movement of the camera from one place to another. It starts and ends gently, follows the globe's curve, and climbs
/// on the way if the way is long. The functions of this header are pure. thread: any
struct Flight {
  Camera from;
  Camera to;
  double summit_m = 0.0;  ///< height at the middle of a long way; no climb if this is below both ends
  Seconds duration{0.0};
};

/// Plans a flight of 0.6 to 2.5 s. The duration depends on the distance and on the change of height.
[[nodiscard]] Flight plan_flight(const Camera& from, const Camera& to, const Ellipsoid& ellipsoid);

/// Returns the camera at a time after the start. It is exactly `from` before 0, and exactly `to` at and after the
/// duration. Latitude, longitude and heading change as one rotation, so a way over a pole is as smooth as any other.
[[nodiscard]] Camera flight_camera(const Flight& flight, Seconds since_start);

/// Smooth step from 0 to 1 with zero speed and acceleration at both ends. x is clamped to [0, 1].
[[nodiscard]] double ease_in_out(double x);

}  // namespace terrella
