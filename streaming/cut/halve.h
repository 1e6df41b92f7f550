#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace terrella {

/// Pixel loops of the cutter, for four interleaved channels. Rows between levels are floats in [0, 255] with 24
/// significant bits, so that rounding errors do not add up from level to level. thread: any

/// out[i] = mean over pixels 2i and 2i+1 of (weight_a · a + weight_b · b). The weights add up to 1; a may be b. `out`
/// holds 4 · pairs values, a and b twice as many.
void halve_rows(const std::uint8_t* a, const std::uint8_t* b, float weight_a, float weight_b, float* out,
                std::size_t pairs);
void halve_rows(const float* a, const float* b, float weight_a, float weight_b, float* out, std::size_t pairs);

/// Rounds to 8 bits, halves up.
void to_bytes(std::span<const float> row, std::uint8_t* out);

/// True if all pixels have alpha 255.
[[nodiscard]] bool are_opaque(std::span<const std::uint8_t> rgba);

/// Multiplies colour by alpha before averaging, so that invisible pixels do not tint visible ones. Opaque pixels become
/// their own values.
void premultiply(std::span<const std::uint8_t> rgba, float* out);
/// Reverses premultiply() and rounds to 8 bits. Pixels with alpha 0 get no colour.
void unpremultiply(std::span<const float> row, std::uint8_t* out);

}  // namespace terrella
