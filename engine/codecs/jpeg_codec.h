#pragma once

#include "codecs/image.h"

namespace terrella {

/// decode_image() for bytes that sniff_format() recognised as JPEG. A warning of the decoder (truncated data, corrupt
/// codes) is an error. Refuses CMYK. thread: any
[[nodiscard]] Result<Image> decode_jpeg(std::span<const std::byte> bytes, const DecodeLimits& limits);
/// Reads the size from the header without decoding. thread: any
[[nodiscard]] Result<PictureSize> jpeg_size(std::span<const std::byte> bytes);

}  // namespace terrella
