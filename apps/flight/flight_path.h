#pragma once

#include <optional>
#include <span>
#include <vector>

#include "apps/flight/eye_way.h"
#include "apps/flight/monotone_curve.h"
#include "base/utc_time.h"
#include "geo/camera.h"

// thread: any, for all of this header
namespace terrella {

/// A view with what goes with it: a keyframe of a flight, or its state at a time.
struct FlightMoment {
  Camera camera;
  std::optional<double> surface_alpha{};  ///< opacity of the surface, [0, 1]; none: as the scene has it
  std::optional<UtcTime> sun{};           ///< time of Sun and sky; none: as the scene has it
  bool operator==(const FlightMoment&) const = default;
};

/// A flight of the eye through keyframes. The eye moves along an EyeWay. The logarithm of its height, pitch, opacity
/// and time follow monotone curves, so that the eye never sinks under the lower one of two keyframes. The heading turns
/// the shorter way; where the way passes within about 15° of a pole, it turns with the course of the eye, because north
/// turns round there. The field of view is the first keyframe's.
class FlightPath {
 public:
  /// A keyframe for each time, one at least. Times ascend, seconds. All keyframes have an opacity, or none; the same
  /// for `sun`.
  FlightPath(std::vector<double> times, const std::vector<FlightMoment>& keyframes);
  [[nodiscard]] const std::vector<double>& times() const { return times_; }  ///< seconds at the keyframes
  [[nodiscard]] double duration_s() const { return times_.back(); }
  /// The moment at a time. Outside the keyframes' times it is that of the first or last keyframe.
  [[nodiscard]] FlightMoment at(double time_s) const;

 private:
  /// Headings in a section that passes a pole: their difference to the course at its begin, and the change of that.
  struct PolarSection {
    double begin_deg, change_deg;
  };
  void set_headings(const std::vector<FlightMoment>& keyframes);
  [[nodiscard]] Angle heading(double time_s) const;

  std::vector<double> times_;
  Angle fov_y_;
  EyeWay way_;
  MonotoneCurve log_height_, heading_deg_, pitch_deg_;
  std::optional<MonotoneCurve> surface_alpha_, sun_ms_;  ///< sun_ms_: since first_sun_
  UtcTime first_sun_{};
  std::vector<std::optional<PolarSection>> polar_;
};

// Flights one after the other, at least one.
[[nodiscard]] double duration_s(std::span<const FlightPath> flights);
/// The moment some seconds later than a time, or earlier, in the flight of that time. Outside the flight's times it is
/// its first or last moment.
[[nodiscard]] FlightMoment moment_at(std::span<const FlightPath> flights, double time_s, double later_s = 0.0);

/// Seconds at which an eye passes keyframes at an even pace, from 0 on: 4 s for a way as long as the eye is high, for a
/// height that changes by a factor of 2.7, or for a turn by a radian. Ways are as long as on the Earth.
[[nodiscard]] std::vector<double> even_pace(const std::vector<FlightMoment>& keyframes);

/// Interpolates the camera between two positions, t in [0, 1]. The eye follows the great circle, and the logarithm of
/// its height is interpolated. The view direction is that of `a`.
[[nodiscard]] Camera camera_between(const Camera& a, const Camera& b, double t);

/// Logarithm of the eye's height, which is taken as 0.1 m at least.
[[nodiscard]] double log_height(const Camera& camera);
/// Geodetic normal at the eye.
[[nodiscard]] glm::dvec3 eye_normal(const Camera& camera);

}  // namespace terrella
