#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>

#include "codecs/image.h"
#include "codecs/numbers.h"

namespace terrella {

/// Decoded pixels of a block: colours or numbers.
using Block = std::variant<Image, Numbers>;

[[nodiscard]] inline int width_px(const Block& block) {
  return std::visit([](const auto& pixels) { return pixels.width_px; }, block);
}
[[nodiscard]] inline int height_px(const Block& block) {
  return std::visit([](const auto& pixels) { return pixels.height_px; }, block);
}
[[nodiscard]] inline std::size_t size_bytes(const Block& block) {
  const auto pixels = static_cast<std::size_t>(width_px(block)) * static_cast<std::size_t>(height_px(block));
  return pixels * 4;  // RGBA8 or a float
}

/// Averages squares of 2^halvings × 2^halvings pixels. Colours are weighted by alpha; NaN takes no part. Squares at the
/// right and lower edges may be smaller. thread: any
[[nodiscard]] Block reduced(const Block& block, int halvings);

/// Enlarges a part of a block to the size of a whole block, bilinearly: part (x, y) of 2^steps × 2^steps. Uses pixels
/// beyond the edge of the part if the block has them. thread: any
[[nodiscard]] Block enlarged_part(const Block& block, int steps, std::int64_t part_x, std::int64_t part_y);

}  // namespace terrella
