#pragma once

#include <chrono>

#include "geo/camera.h"

// thread: any, for all of this header
namespace terrella {

using Seconds = std::chrono::duration<double>;

/// A way from one camera to another: eased at both ends, over the globe's curve, higher on the way if it is long.
struct Flight {
  Camera from;
  Camera to;
  double summit_m = 0.0;  ///< height that the middle of a long way reaches; below both ends: no climb
  Seconds duration{0.0};
};

/// Plans a flight; lasts 0.6 to 2.5 s by how far and how much higher or lower it goes.
[[nodiscard]] Flight plan_flight(const Camera& from, const Camera& to, const Ellipsoid& ellipsoid);

/// Where the flight is after a time; at and after the duration exactly `to`, before 0 exactly `from`.
/// Latitude, longitude and heading turn as one rotation, so a way over a pole is as smooth as any other.
[[nodiscard]] Camera flight_camera(const Flight& flight, Seconds since_start);

/// 0 to 1 with speed and acceleration zero at both ends; clamps.
[[nodiscard]] double ease_in_out(double x);

}  // namespace terrella
