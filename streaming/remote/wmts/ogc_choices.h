#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace terrella {

/// Pixel of the OGC's scale denominators, metres (OGC 07-057r7, 6.1; OGC 06-042, 7.2.4.6.9).
inline constexpr double kOgcPixel_m = 0.00028;
/// Longest name or attribution that is taken from a document.
inline constexpr std::size_t kMaxOgcTextBytes = 16384;
/// Time until an absent tile of the newest time is requested again.
inline constexpr std::chrono::seconds kNewestMissingLife{3600};
/// Limit of root tiles, because they are always in memory.
inline constexpr std::int64_t kMaxRootTiles = 512;

/// Names for a message, at most 20 and each at most 100 bytes: "a, b and 3 more"; "none" for no names. thread: any
[[nodiscard]] std::string list_of(const std::vector<std::string>& names);

}  // namespace terrella
