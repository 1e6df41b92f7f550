#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "apps/flight/flight_path.h"
#include "base/result.h"

// thread: any, for all of this header
namespace terrella {

/// The frames of a film: flights one after the other, at a number of frames a second. Frame k shows the time k / fps,
/// so that the film lasts as long as its flights.
class FilmPlan {
 public:
  /// Fails for more than a million frames; the error names the cure. At least one path; fps > 0.
  [[nodiscard]] static Result<FilmPlan> make(std::vector<FlightPath> paths, double fps);

  [[nodiscard]] std::int64_t frames() const { return frames_; }  ///< at least 1
  /// The moment of a frame, or one that is some seconds later. Frames do not see over the end of their flight.
  [[nodiscard]] FlightMoment moment(std::int64_t frame, double later_s = 0.0) const;
  /// The moments that a frame averages: evenly over the time that the shutter is open, part of a frame's time. As
  /// usual in animation, it is open before and after the frame's own time for as long. A shutter of 0: that time alone.
  [[nodiscard]] std::vector<FlightMoment> moments(std::int64_t frame, double shutter, int count) const;
  /// The first time of the flights' Sun; none if they set no time.
  [[nodiscard]] std::optional<UtcTime> first_sun() const;

 private:
  FilmPlan(std::vector<FlightPath> paths, double fps) : paths_(std::move(paths)), fps_(fps) {}

  std::vector<FlightPath> paths_;
  double fps_;
  std::int64_t frames_ = 1;
};

}  // namespace terrella
