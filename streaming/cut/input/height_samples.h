#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tiles/tile_source.h"

namespace terrella {

enum class HeightKind { uint16, int16, float32 };

/// Conversion of a picture's height samples to the whole numbers of tiles.
struct HeightCoding {
  HeightKind kind = HeightKind::uint16;
  std::optional<double> nodata = {};  ///< sample value that means "no height"
  double scale = 1.0;                 ///< for float32: number = (sample - offset) / scale
  double offset = 0.0;
};

/// Converts samples in this machine's byte order to floats in units of the tiles' numbers, NaN for no height
/// (streaming/cut/input/heights.h). `numbers` has 4 bytes per pixel. thread: any
void to_numbers(const HeightCoding& coding, const std::uint8_t* samples, std::size_t pixel_bytes, std::size_t pixels,
                std::uint8_t* numbers);

}  // namespace terrella
