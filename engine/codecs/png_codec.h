#pragma once

#include "codecs/image.h"

namespace terrella {

/// decode_image() for bytes that sniff_format() took for a PNG. Sixteen bits are rounded to eight, palettes and gray
/// are expanded; gamma and colour profiles are not applied. thread: any
[[nodiscard]] Result<Image> decode_png(std::span<const std::byte> bytes, const DecodeLimits& limits);
/// The numbers of a gray PNG of 16 bits, in this machine's order, rows from the top. Any other PNG is refused, and the
/// error says what it is. thread: any
struct Gray16 {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint16_t> values;
};
[[nodiscard]] Result<Gray16> decode_gray16_png(std::span<const std::byte> bytes, const DecodeLimits& limits);
/// What the header says; nothing is decoded. thread: any
[[nodiscard]] Result<PictureSize> png_size(std::span<const std::byte> bytes);

}  // namespace terrella
