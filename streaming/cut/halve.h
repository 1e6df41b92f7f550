#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace terrella {

/// The loops over pixels of the cutter: four channels interleaved. Between levels rows are floats in [0, 255], 24 bits
/// a sample, so that rounding does not build up from level to level. thread: any

/// out[i] = mean over pixels 2i and 2i+1 of (weight_a · a + weight_b · b). The weights add up to 1; a may be b.
/// `out` holds 4 · pairs values, a and b twice as many.
void halve_rows(const std::uint8_t* a, const std::uint8_t* b, float weight_a, float weight_b, float* out,
                std::size_t pairs);
void halve_rows(const float* a, const float* b, float weight_a, float weight_b, float* out, std::size_t pairs);

/// Rounds to 8 bits, a half up.
void to_bytes(std::span<const float> row, std::uint8_t* out);

/// Colour times alpha, as averaging needs it: otherwise what is invisible would tint what is not.
void premultiply(std::span<const std::uint8_t> rgba, float* out);
/// The way back, rounded to 8 bits; no colour where alpha is 0.
void unpremultiply(std::span<const float> row, std::uint8_t* out);

}  // namespace terrella
