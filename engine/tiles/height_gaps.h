#pragma once

#include <cstdint>
#include <vector>

namespace terrella {

/// Gives heights that are unknown (0 in `known`) what lies around them, so that a hole in the data is neither a pit nor
/// a spike: the mean of the neighbours, pixel by pixel inwards, and falling evenly to 0, the level that heights count
/// from, over min(64, a quarter of the side) pixels. Both arrays are side_px · side_px, row-major. thread: any
void fill_gaps(std::vector<float>& heights_m, std::vector<std::uint8_t> known, int side_px);

}  // namespace terrella
