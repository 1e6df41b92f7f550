#pragma once

#include "codecs/image.h"

namespace terrella {

/// decode_image() for bytes that sniff_format() recognised as WebP, lossy or lossless. Refuses animations. Bytes after
/// the picture are ignored. Does not apply colour profiles and EXIF. thread: any
[[nodiscard]] Result<Image> decode_webp(std::span<const std::byte> bytes, const DecodeLimits& limits);
/// Reads the size from the header without decoding. thread: any
[[nodiscard]] Result<PictureSize> webp_size(std::span<const std::byte> bytes);

/// Facts in the header of a WebP.
struct WebpHeader {
  PictureSize size;
  bool has_alpha = false;
};
/// Reads the header; refuses animations. thread: any
[[nodiscard]] Result<WebpHeader> webp_header(std::span<const std::byte> bytes);
/// Length of the file by its first 12 bytes, which sniff_format() recognised. A shorter file is truncated. thread: any
[[nodiscard]] std::uint64_t webp_length(std::span<const std::byte> bytes);

}  // namespace terrella
