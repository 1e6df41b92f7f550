#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/utc_time.h"

// thread: any, for all of this header
namespace terrella {

/// The last part of a date or time that a text of ISO 8601 gives.
enum class TimePrecision { year, month, day, minute, second, millisecond };

/// The time that a text of ISO 8601 names: 2004-08 is all of August.
struct NamedTime {
  UtcTime from{}, before{};  ///< its first instant, and the first one after it
  TimePrecision precision = TimePrecision::day;
  bool has_z = false;  ///< the text ends with Z
};

/// Reads YYYY[-MM[-DD[Thh:mm[:ss[.fraction]]]]][Z] in UTC; nothing for other texts.
[[nodiscard]] std::optional<NamedTime> read_named_time(std::string_view text);

/// True for words of servers for their newest time, in any case: "current", "latest", "now", "present".
[[nodiscard]] bool names_newest(std::string_view text);

/// Writes an instant with a precision, as read_named_time() reads it. Finer parts are left out.
[[nodiscard]] std::string time_text(UtcTime time, TimePrecision precision, bool with_z);

/// A period of ISO 8601, such as P1D, PT10M, P1M or P1Y: months, which differ in length, and a length besides them.
struct TimePeriod {
  int months = 0;
  std::chrono::milliseconds length{0};
  bool operator==(const TimePeriod&) const = default;
};

/// Reads a period of some years, months, weeks, days, hours, minutes or seconds, each a whole number; nothing for other
/// texts and for a period of nothing.
[[nodiscard]] std::optional<TimePeriod> read_period(std::string_view text);

/// Writes a period as read_period() reads it, in its largest units.
[[nodiscard]] std::string period_text(const TimePeriod& period);

/// Returns the instant that lies some periods after another. The days of a month that is too short are its last one.
[[nodiscard]] UtcTime after_periods(UtcTime from, const TimePeriod& period, std::int64_t count);

}  // namespace terrella
