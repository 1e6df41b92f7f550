#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Limit on a document. NASA GIBS' document of all layers has about 5 MB.
inline constexpr std::size_t kMaxCapabilitiesBytes = 32UL << 20;
/// Pixel of the OGC's scale denominators, metres (OGC 07-057r7, 6.1; OGC 06-042, 7.2.4.6.9).
inline constexpr double kOgcPixel_m = 0.00028;
/// Longest name or attribution that is taken from a document.
inline constexpr std::size_t kMaxOgcTextBytes = 16384;
/// Limit of root tiles, because they are always in memory.
inline constexpr std::int64_t kMaxRootTiles = 512;

/// Names for a message, at most 20 and each at most 100 bytes: "a, b and 3 more"; "none" for no names. thread: any
[[nodiscard]] std::string list_of(const std::vector<std::string>& names);

/// Reads capabilities: checks the options, the document and the set that `describe` makes of its root. `fault_of` gives
/// the reason why a root is no such document, or nothing. The error begins with `where`. thread: any
[[nodiscard]] Result<RemoteTileSet> read_capabilities(
    std::string_view xml, const RemoteOptions& options, const std::string& where,
    const std::function<std::string(const pugi::xml_node& root)>& fault_of,
    const std::function<Result<RemoteTileSet>(const pugi::xml_node& root)>& describe);

}  // namespace terrella
