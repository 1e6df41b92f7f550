#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// A decoded picture: RGBA8, not premultiplied, sRGB as stored, rows from the top, no padding.
struct Image {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgba;  ///< width · height · 4 bytes
};

/// Limits of a decoder's memory. A picture over a limit is refused before its pixels are read.
struct DecodeLimits {
  int max_side_px = 8192;
  std::size_t max_bytes = 256UL << 20;  ///< decoded pixels
};

enum class ImageFormat { jpeg, png, unknown };
/// Looks at the first bytes, not at a name. thread: any
[[nodiscard]] ImageFormat sniff_format(std::span<const std::byte> bytes);

/// The size in a picture's header, pixels; not checked against any limit.
struct PictureSize {
  int width_px = 0;
  int height_px = 0;
};

/// Decodes a JPEG or PNG tile from memory. Never throws, never crashes on hostile bytes. A truncated picture is an
/// error. thread: any
[[nodiscard]] Result<Image> decode_image(std::span<const std::byte> bytes, const DecodeLimits& limits = {});

/// Encodes a picture. JPEG: quality 1…100, alpha dropped, 4:2:0. PNG: RGB if every alpha is 255, else RGBA. thread: any
[[nodiscard]] Result<std::vector<std::byte>> encode_jpeg(const Image& image, int quality);
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const Image& image);

}  // namespace terrella
