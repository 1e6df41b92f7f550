#pragma once

#include <chrono>
#include <string>

#include "base/result.h"

namespace terrella {

/// A part of each day, over midnight if `last` is before `first`.
struct DayHours {
  std::chrono::minutes first{0}, last{0};  ///< since midnight; they differ
  bool utc = false;                        ///< false: local time
  std::string text{};                      ///< as the user wrote it
};

/// Reads "22:00-06:00" in local time, or "22:00-06:00Z" in UTC. The error names the text. thread: any
[[nodiscard]] Result<DayHours> parse_day_hours(const std::string& text);

/// The time from a moment of the day until the hours begin; 0 within them. thread: any
[[nodiscard]] std::chrono::seconds wait_for(const DayHours& hours, std::chrono::seconds since_midnight);
/// The moment of the day of an instant, in the zone of the hours. thread: any, while nobody changes the zone
[[nodiscard]] std::chrono::seconds since_midnight(const DayHours& hours, std::chrono::system_clock::time_point now);

}  // namespace terrella
