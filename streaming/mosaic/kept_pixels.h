#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/result.h"
#include "streaming/warp/block.h"

namespace terrella {

/// Pixels as bytes for the store, without loss: colours as PNG, numbers as floats packed by zlib. Empty if they cannot
/// be packed. thread: any
[[nodiscard]] std::vector<std::byte> pack_pixels(const Block& block);
/// Unpacks the pixels of a tile of `side_px`. thread: any
[[nodiscard]] Result<Block> unpack_pixels(std::span<const std::byte> bytes, int side_px, bool numbers);

}  // namespace terrella
