#pragma once

#include <string>

#include "base/result.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// Reads "I/N" with I in 1...N, N at most a million. The error quotes the text. thread: any
[[nodiscard]] Result<Shard> parse_shard(const std::string& text);

}  // namespace terrella
