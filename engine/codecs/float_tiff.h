#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/result.h"

namespace terrella {

/// The numbers of a TIFF in memory that holds side_px × side_px of one 32-bit float a pixel in strips, as OGC 17-066r1
/// (requirements class TIFF) has it; rows from the top. Numbers may be NaN or infinite. Anything else is refused, and
/// the error says what it is. Never crashes on hostile bytes, nor allocates more than a small multiple of the result.
/// thread: any
[[nodiscard]] Result<std::vector<float>> decode_float_tiff(std::span<const std::byte> bytes, int side_px);

}  // namespace terrella
