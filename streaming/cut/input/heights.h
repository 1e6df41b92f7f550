#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace terrella {

/// Heights in strips and between levels, in units of the tiles' whole numbers (metres = number · scale + offset). A
/// pixel takes four bytes as colours do: as read a 32-bit float, NaN where there is no height; in a finished row the 16
/// bits of a tile in its first two bytes, in this machine's order. Between levels they are premultiplied rows like
/// those of colours: (height · share, 0, 0, share), so that only what is known has a part in a mean. thread: any

void heights_to_floats(std::span<const std::uint8_t> pixels, float* out);

/// Rounds to whole numbers in [0, 65535]. Where nothing is known: nodata. A height that falls on nodata is moved by
/// one.
void floats_to_heights(std::span<const float> row, std::optional<std::uint16_t> nodata, std::uint8_t* out);

/// (1 - share) · a + share · b of two finished pixels; where one is nodata the other.
void mix_heights(const std::uint8_t* a, const std::uint8_t* b, float share, std::optional<std::uint16_t> nodata,
                 std::uint8_t* out);

/// The 16 bits of a finished pixel.
[[nodiscard]] std::uint16_t height_at(const std::uint8_t* pixel);

}  // namespace terrella
