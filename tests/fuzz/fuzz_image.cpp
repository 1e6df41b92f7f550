#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "codecs/image.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr terrella::DecodeLimits kLimits{.max_side_px = 512, .max_bytes = 1UL << 20};
  const auto image = terrella::decode_image(std::as_bytes(std::span(data, size)), kLimits);
  if (image && image->rgba.size() > kLimits.max_bytes) std::abort();
  if (!image && image.error().message.empty()) std::abort();
  return 0;
}
