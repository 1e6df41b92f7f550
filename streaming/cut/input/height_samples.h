#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tiles/tile_source.h"

namespace terrella {

enum class HeightKind { uint16, int16, float32 };

/// How the samples of a picture of heights become the whole numbers of tiles.
struct HeightCoding {
  HeightKind kind = HeightKind::uint16;
  std::optional<double> nodata = {};  ///< a sample that is no height
  double scale = 1.0;                 ///< of float32: number = (sample - offset) / scale
  double offset = 0.0;
};

/// Turns samples in this machine's order into floats in units of the tiles' numbers, NaN where there is no height
/// (streaming/cut/input/heights.h). `numbers` takes 4 bytes a pixel. thread: any
void to_numbers(const HeightCoding& coding, const std::uint8_t* samples, std::size_t pixel_bytes, std::size_t pixels,
                std::uint8_t* numbers);

}  // namespace terrella
