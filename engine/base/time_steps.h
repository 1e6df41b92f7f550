#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/iso_time.h"
#include "base/result.h"

namespace terrella {

/// Instants at equal periods, or one instant.
struct TimeSeries {
  UtcTime first{}, last{};  ///< last: the last step, not beyond what the service says
  std::int64_t count = 1;
  TimePeriod period{};  ///< empty for one instant
  TimePrecision precision = TimePrecision::day;
  bool has_z = false;
};

/// The instants at which a layer has pictures, as WMTS and WMS give them: single ones and series, in any order. A plain
/// value; memory grows with the number of series, not of instants. thread: any
class TimeSteps {
 public:
  /// More instants in a series are refused.
  static constexpr std::int64_t kMostInSeries = 1'000'000'000;

  /// Reads values, each an instant or START/END/PERIOD (OGC 06-042, annex D). `now` is the end of a series whose END is
  /// "current", "now" or "present". Two values without a period are an interval whose instants nobody knows: its ends
  /// are steps. The error names the value.
  [[nodiscard]] static Result<TimeSteps> parse(std::span<const std::string> values, UtcTime now);

  [[nodiscard]] bool empty() const { return series_.empty(); }
  /// All series, in the order of their first instants.
  [[nodiscard]] const std::vector<TimeSeries>& series() const { return series_; }
  [[nodiscard]] std::int64_t count() const;  ///< instants of all series
  [[nodiscard]] UtcTime first() const { return series_.front().first; }
  [[nodiscard]] UtcTime last() const;

  // Nothing if there is no such step.
  [[nodiscard]] std::optional<UtcTime> at_or_before(UtcTime time) const;
  [[nodiscard]] std::optional<UtcTime> after(UtcTime time) const;

  /// Writes a step as the service does.
  [[nodiscard]] std::string text(UtcTime step) const;
  /// "2012-05-08 to 2012-05-31: 22 instants, P1D, 1 gap": the first and the last instant, their number, the period if
  /// all series have the same one, and the times at which more than a period is between two instants.
  [[nodiscard]] std::string summary() const;

 private:
  std::vector<TimeSeries> series_;
};

}  // namespace terrella
