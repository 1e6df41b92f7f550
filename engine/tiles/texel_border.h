#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace terrella {

/// Returns a square of side × side texels of kBytes each, in a border of `border` clamped texels per side.
/// write_row(row, target) writes the texels of a row. thread: any
template <std::size_t kBytes, class WriteRow>
std::vector<std::uint8_t> with_border(std::size_t side, std::size_t border, const WriteRow& write_row) {
  const std::size_t row_bytes = (side + 2 * border) * kBytes;
  std::vector<std::uint8_t> texels(row_bytes * (side + 2 * border));
  const auto fill = [border](std::uint8_t* first, const std::uint8_t* texel) {
    for (std::size_t i = 0; i < border; ++i) std::memcpy(first + i * kBytes, texel, kBytes);
  };
  for (std::size_t row = 0; row < side; ++row) {
    std::uint8_t* line = texels.data() + (row + border) * row_bytes;
    std::uint8_t* inner = line + border * kBytes;
    write_row(row, inner);
    fill(line, inner);
    fill(inner + side * kBytes, inner + (side - 1) * kBytes);
  }
  std::uint8_t* first = texels.data() + border * row_bytes;
  std::uint8_t* last = first + (side - 1) * row_bytes;
  for (std::size_t i = 0; i < border; ++i) {
    std::memcpy(texels.data() + i * row_bytes, first, row_bytes);
    std::memcpy(last + (i + 1) * row_bytes, last, row_bytes);
  }
  return texels;
}

}  // namespace terrella
