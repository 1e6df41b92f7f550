#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/time_steps.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

// thread: any, for all of this header
namespace terrella {

/// Time until an absent tile of the newest time is requested again.
inline constexpr std::chrono::seconds kNewestMissingLife{3600};

/// The set at its last step at or before a time. Causes no request. Fails if no steps are known, or if the time is
/// before the first step, which the error names.
[[nodiscard]] Result<RemoteTileSet> at_time(const RemoteTileSet& set, UtcTime time);

/// The first instant after a series, whose last step may name a whole day or month.
[[nodiscard]] UtcTime end_of(const TimeSeries& series);
/// True within a day of the last instant, and for "current", "default" and the like.
[[nodiscard]] bool is_newest(const TimeSteps& steps, const std::string& time);

/// Sets steps, times and instant of a description.
void set_steps(TimeSteps steps, TileSetInfo& info);

/// True for a text with a placeholder of a time: {time} or {time:FORMAT}.
[[nodiscard]] bool has_time(std::string_view text);
/// True for the names of placeholders of a time: "time" and "time:FORMAT".
[[nodiscard]] bool is_time_placeholder(std::string_view name);
/// Reason why a placeholder has no text, which names the unknown code of its FORMAT; empty: it has, or is none of time.
[[nodiscard]] std::string fault_of_time_placeholder(std::string_view name);
/// Writes a time in UTC by the codes of strftime %Y %y %m %b %B %d %j %H %M %S %s %%. The error is the unknown code.
[[nodiscard]] Result<std::string> format_time(UtcTime time, std::string_view format);
/// Text of a placeholder in an address: TileSetInfo::time, or TileSetInfo::instant in UTC by the codes of strftime
/// %Y %y %m %b %B %d %j %H %M %S %s %%. Empty if the set has none.
[[nodiscard]] std::string time_in_url(const TileSetInfo& info, std::string_view name);
/// The set's template with its time in place of placeholders of a time.
[[nodiscard]] Url url_at_its_time(const RemoteTileSet& set);

/// Chooses the time of a URL template with {time}: the last of `options.times` at or before `options.time`, else the
/// newest. Fails if it has {time} or times but not both.
[[nodiscard]] Status choose_template_time(RemoteTileSet& set, const RemoteOptions& options, const std::string& where);

}  // namespace terrella
