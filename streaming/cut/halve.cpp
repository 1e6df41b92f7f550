#include "streaming/cut/halve.h"

#include <algorithm>

namespace terrella {
namespace {

/// Pixels that stay in the first-level cache between the two passes.
constexpr std::size_t kBlock = 512;

template <class T>
void halve(const T* __restrict a, const T* __restrict b, float weight_a, float weight_b, float* __restrict out,
           std::size_t pairs) {
  const float half_a = 0.5F * weight_a;
  const float half_b = 0.5F * weight_b;
  float mixed[kBlock * 8];
  for (std::size_t done = 0; done < pairs; done += kBlock) {
    const std::size_t count = std::min(kBlock, pairs - done);
    const T* from_a = a + done * 8;
    const T* from_b = b + done * 8;
    for (std::size_t i = 0; i < count * 8; ++i) {
      mixed[i] = half_a * static_cast<float>(from_a[i]) + half_b * static_cast<float>(from_b[i]);
    }
    float* to = out + done * 4;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < 4; ++c) to[i * 4 + c] = mixed[i * 8 + c] + mixed[i * 8 + 4 + c];
    }
  }
}

}  // namespace

void halve_rows(const std::uint8_t* a, const std::uint8_t* b, float weight_a, float weight_b, float* out,
                std::size_t pairs) {
  halve(a, b, weight_a, weight_b, out, pairs);
}

void halve_rows(const float* a, const float* b, float weight_a, float weight_b, float* out, std::size_t pairs) {
  halve(a, b, weight_a, weight_b, out, pairs);
}

void to_bytes(std::span<const float> row, std::uint8_t* out) {
  for (std::size_t i = 0; i < row.size(); ++i) out[i] = static_cast<std::uint8_t>(static_cast<int>(row[i] + 0.5F));
}

bool are_opaque(std::span<const std::uint8_t> rgba) {
  std::uint8_t all = 255;
  for (std::size_t i = 3; i < rgba.size(); i += 4) all &= rgba[i];
  return all == 255;
}

void premultiply(std::span<const std::uint8_t> rgba, float* out) {
  if (are_opaque(rgba)) {
    for (std::size_t i = 0; i < rgba.size(); ++i) out[i] = static_cast<float>(rgba[i]);
    return;
  }
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    const float alpha = static_cast<float>(rgba[i + 3]);
    for (std::size_t c = 0; c < 3; ++c) out[i + c] = static_cast<float>(rgba[i + c]) * alpha / 255.0F;
    out[i + 3] = alpha;
  }
}

void unpremultiply(std::span<const float> row, std::uint8_t* out) {
  for (std::size_t i = 0; i < row.size(); i += 4) {
    const float alpha = row[i + 3];
    const float scale = alpha > 0.0F ? 255.0F / alpha : 0.0F;
    for (std::size_t c = 0; c < 3; ++c) {
      out[i + c] = static_cast<std::uint8_t>(static_cast<int>(std::min(255.0F, row[i + c] * scale) + 0.5F));
    }
    out[i + 3] = static_cast<std::uint8_t>(static_cast<int>(alpha + 0.5F));
  }
}

}  // namespace terrella
