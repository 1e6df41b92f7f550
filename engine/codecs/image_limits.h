#pragma once

#include <cstdint>

#include "codecs/image.h"

namespace terrella {

/// Refuses a picture of zero size or over a limit. Called before the pixels are allocated. thread: any
[[nodiscard]] Status check_size(std::uint64_t width_px, std::uint64_t height_px, const DecodeLimits& limits);

/// Refuses a picture that cannot be encoded: see check_image(), and qualities other than 1…100. thread: any
[[nodiscard]] Status check_encoding(const Image& image, int quality);

}  // namespace terrella
