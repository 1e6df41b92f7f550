#pragma once

#include "codecs/image.h"

namespace terrella {

/// decode_image() for bytes that sniff_format() took for a JPEG. A warning of the decoder (data that ends too early,
/// corrupt codes) is an error. CMYK is refused. thread: any
[[nodiscard]] Result<Image> decode_jpeg(std::span<const std::byte> bytes, const DecodeLimits& limits);
/// What the header says; nothing is decoded. thread: any
[[nodiscard]] Result<PictureSize> jpeg_size(std::span<const std::byte> bytes);

}  // namespace terrella
