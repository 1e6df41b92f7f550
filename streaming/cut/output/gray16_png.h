#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"

namespace terrella {

/// A square PNG of one channel of 16 bits: what a tile of a gridded coverage is (OGC 17-066r1). thread: any
[[nodiscard]] Result<std::vector<std::byte>> encode_gray16_png(std::span<const std::uint16_t> values, int side_px);

}  // namespace terrella
