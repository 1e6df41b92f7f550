#pragma once

#include <chrono>
#include <string_view>

#include "base/result.h"

namespace terrella {

/// An instant of UTC without leap seconds, counted as std::chrono does.
using UtcTime = std::chrono::sys_time<std::chrono::milliseconds>;

/// Reads ISO 8601 in UTC: "2026-06-21", "2026-06-21T12:00Z" or "2026-06-21T12:00:00[.25]Z". A blank may replace the T,
/// and the Z is optional. Refuses days that do not exist, leap seconds, other zones and years outside 0001...9999. The
/// error quotes the text. Digits beyond milliseconds are cut off. thread: any
[[nodiscard]] Result<UtcTime> parse_utc(std::string_view text);

}  // namespace terrella
