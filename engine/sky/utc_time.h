#pragma once

#include <chrono>
#include <string_view>

#include "base/result.h"

namespace terrella {

/// An instant of UTC, without leap seconds, as std::chrono counts it.
using UtcTime = std::chrono::sys_time<std::chrono::milliseconds>;

/// Reads ISO 8601 in UTC: "2026-06-21", "2026-06-21T12:00Z" or "2026-06-21T12:00:00[.25]Z"; a blank may stand for the T
/// and the Z may be left out. Refuses days that the calendar has not, a leap second, other zones and years outside
/// 0001...9999; the error names the text. Milliseconds are kept, what is finer is cut off. thread: any
[[nodiscard]] Result<UtcTime> parse_utc(std::string_view text);

}  // namespace terrella
