#pragma once

#include "codecs/image.h"

namespace terrella {

/// decode_image() for bytes that sniff_format() recognised as PNG. Rounds 16 bits to 8 and expands palettes and gray.
/// Does not apply gamma and colour profiles. thread: any
[[nodiscard]] Result<Image> decode_png(std::span<const std::byte> bytes, const DecodeLimits& limits);
/// The numbers of a gray PNG of 16 bits, in native byte order, rows from the top. Any other PNG is refused, with an
/// error that says what differs. thread: any
struct Gray16 {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint16_t> values;
};
[[nodiscard]] Result<Gray16> decode_gray16_png(std::span<const std::byte> bytes, const DecodeLimits& limits);
/// Reads the size from the header without decoding. thread: any
[[nodiscard]] Result<PictureSize> png_size(std::span<const std::byte> bytes);
/// Encodes a PNG faster than encode_png(), for a user who waits: the filtered rows are searched for runs only. Takes a
/// quarter of the time; a view of the Earth has 2 % more bytes. thread: any
[[nodiscard]] Result<std::vector<std::byte>> encode_png_quickly(const Image& image);

}  // namespace terrella
