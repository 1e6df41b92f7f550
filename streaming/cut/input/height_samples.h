#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "tiles/tile_source.h"

namespace terrella {

enum class HeightKind {
  uint16,   ///< unsigned, at most 16 bits
  int16,    ///< signed, at most 16 bits
  float32,  ///< any other type; read as 32-bit floats
};

/// Conversion of a picture's height samples to the whole numbers of tiles.
struct HeightCoding {
  HeightKind kind = HeightKind::uint16;
  std::size_t band = 0;               ///< band of a TIFF, counted from 0
  std::optional<double> nodata = {};  ///< sample value that means "no height"
  double scale = 1.0;                 ///< for float32: number = (sample - offset) / scale
  double offset = 0.0;
  double sample_scale = 1.0;  ///< for float32, from the file: metres = stored sample · sample_scale + sample_offset
  double sample_offset = 0.0;
};

/// Converts heights to units of the tiles' numbers, in place: samples for integers, metres for float32. NaN stays NaN
/// (streaming/cut/input/heights.h). thread: any
void to_numbers(const HeightCoding& coding, std::span<float> heights);

}  // namespace terrella
