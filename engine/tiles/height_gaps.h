#pragma once

#include <cstdint>
#include <vector>

namespace terrella {

/// Fills unknown heights (0 in `known`) from the heights around them, so that a hole in the data makes neither a pit
/// nor a spike. Works inwards pixel by pixel: each gets the mean of its known neighbours. The values fall evenly to 0,
/// the data's zero level, over min(64, side / 4) pixels. Both arrays are side_px · side_px, row-major. thread: any
void fill_gaps(std::vector<float>& heights_m, std::vector<std::uint8_t> known, int side_px);

}  // namespace terrella
