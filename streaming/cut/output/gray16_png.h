#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"

namespace terrella {

/// Encodes a square one-channel 16-bit PNG, the tile format of a gridded coverage (OGC 17-066r1). thread: any
[[nodiscard]] Result<std::vector<std::byte>> encode_gray16_png(std::span<const std::uint16_t> values, int side_px);

}  // namespace terrella
