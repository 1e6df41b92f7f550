#pragma once

#include <array>
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

/// Fails if a picture has no pixels, or if `rgba` has not width · height · 4 bytes. thread: any
[[nodiscard]] Status check_image(const Image& image);

/// Limits of a decoder's memory. A picture over a limit is refused before its pixels are read.
struct DecodeLimits {
  int max_side_px = 8192;
  std::size_t max_bytes = 256UL << 20;  ///< decoded pixels
};

enum class ImageFormat { jpeg, png, webp, unknown };
/// Endings of tile files and names in tileset.json, in the order of ImageFormat.
inline constexpr std::array kImageFormatNames = {"jpg", "png", "webp"};
/// The format's ending; "jpg" for an unknown format. thread: any
[[nodiscard]] const char* extension_of(ImageFormat format);
/// Looks at the first bytes, not at a name. thread: any
[[nodiscard]] ImageFormat sniff_format(std::span<const std::byte> bytes);

/// The size in a picture's header, pixels; not checked against any limit.
struct PictureSize {
  int width_px = 0;
  int height_px = 0;
};

/// Reads the size from the header without decoding. thread: any
[[nodiscard]] Result<PictureSize> picture_size(std::span<const std::byte> bytes);

/// Decodes a JPEG, PNG or WebP tile from memory. Never throws, never crashes on hostile bytes. A truncated picture is
/// an error. thread: any
[[nodiscard]] Result<Image> decode_image(std::span<const std::byte> bytes, const DecodeLimits& limits = {});

/// Encodes a picture. JPEG: quality 1…100, alpha dropped, 4:2:0. PNG: RGB if every alpha is 255, else RGBA. WebP: lossy
/// colours of quality 1…100, lossless alpha if any is below 255; sides up to kMaxWebpSide_px. Fails if the picture does
/// not pass check_image(), or the quality or a side is out of range. thread: any
[[nodiscard]] Result<std::vector<std::byte>> encode_jpeg(const Image& image, int quality);
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const Image& image);
inline constexpr int kMaxWebpSide_px = 16383;
[[nodiscard]] Result<std::vector<std::byte>> encode_webp(const Image& image, int quality);

}  // namespace terrella
