#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "tiles/height_decoder.h"

// A tile of heights: what begins as a PNG is taken for whole numbers, anything else for floats in a TIFF.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr int kSide_px = 16;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  const bool is_png = terrella::sniff_format(bytes) == terrella::ImageFormat::png;
  const terrella::NumberInfo info{.scale = 0.5, .offset = -100.0, .nodata = 7.0, .floats = !is_png};
  const auto tile = terrella::decode_heights({}, {.bytes = {bytes.begin(), bytes.end()}}, info, kSide_px);
  if (!tile) {
    if (tile.error().why.empty()) std::abort();
    return 0;
  }
  if (tile->heights_m.size() != static_cast<std::size_t>(kSide_px * kSide_px)) std::abort();
  for (const float height_m : tile->heights_m) {
    if (!std::isfinite(height_m) || height_m < tile->min_m || height_m > tile->max_m) std::abort();
  }
  return 0;
}
