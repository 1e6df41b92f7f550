#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/result.h"

namespace terrella {

/// Decodes a TIFF in memory with side_px × side_px pixels of one 32-bit float each, in strips (OGC 17-066r1,
/// requirements class TIFF). Returns the numbers, rows from the top; they may be NaN or infinite. Refuses any other
/// TIFF, with an error that says what differs. Never crashes on hostile bytes, and never allocates more than a small
/// multiple of the result. thread: any
[[nodiscard]] Result<std::vector<float>> decode_float_tiff(std::span<const std::byte> bytes, int side_px);

/// Encodes side_px × side_px floats as such a TIFF: one strip, LZW (OGC 17-066r1 allows no other compression). The same
/// numbers give the same bytes. thread: any
[[nodiscard]] Result<std::vector<std::byte>> encode_float_tiff(std::span<const float> numbers, int side_px);

}  // namespace terrella
