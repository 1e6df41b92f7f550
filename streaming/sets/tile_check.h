#pragma once

#include <cstddef>
#include <span>

#include "base/result.h"

namespace terrella {

/// Quick check of a tile's bytes from a server: begins as a JPEG, PNG or WebP, has `tile_px` pixels a side in its
/// header, and ends properly. Decodes no pixel (2 µs rather than 1 ms); `terrella info --verify` decodes. The error
/// says what came instead. thread: any
[[nodiscard]] Status check_tile(std::span<const std::byte> bytes, int tile_px);

}  // namespace terrella
