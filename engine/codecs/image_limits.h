#pragma once

#include <cstdint>

#include "codecs/image.h"

namespace terrella {

/// Refuses a picture of no size, or over a limit; called before its pixels are allocated. thread: any
[[nodiscard]] Status check_size(std::uint64_t width_px, std::uint64_t height_px, const DecodeLimits& limits);

}  // namespace terrella
