#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace terrella {

/// Heights in strips and between levels, in units of the tiles' whole numbers (metres = number · scale + offset). A
/// pixel has four bytes, as for colours.
/// Pixels as read are 32-bit floats, NaN for no height. In a finished row the first two bytes are the 16 bits of a
/// tile, in this machine's byte order. Between levels the rows are premultiplied like colours: (height · share, 0, 0,
/// share). Only known heights therefore count in a mean. thread: any

void heights_to_floats(std::span<const std::uint8_t> pixels, float* out);

/// Rounds to whole numbers in [0, 65535]. Unknown heights become nodata. A known height equal to nodata is moved by
/// one.
void floats_to_heights(std::span<const float> row, std::optional<std::uint16_t> nodata, std::uint8_t* out);

/// Mixes two finished pixels: (1 - share) · a + share · b. If one is nodata, returns the other.
void mix_heights(const std::uint8_t* a, const std::uint8_t* b, float share, std::optional<std::uint16_t> nodata,
                 std::uint8_t* out);

/// Marks a finished pixel as unknown: nodata of heights. Without a nodata the pixel stays.
void clear_height(std::optional<std::uint16_t> nodata, std::uint8_t* out);

/// Numbers that stay 32-bit floats (PixelKind::number): a finished pixel is the float, NaN for no data. Between levels
/// the rows are those of heights.
void floats_to_numbers(std::span<const float> row, std::uint8_t* out);
/// Mixes two finished pixels; if one is unknown, returns the other.
void mix_numbers(const std::uint8_t* a, const std::uint8_t* b, float share, std::uint8_t* out);
/// The float of a finished pixel.
[[nodiscard]] float number_at(const std::uint8_t* pixel);
void put_number(float number, std::uint8_t* out);

/// Reads the 16 bits of a finished pixel.
[[nodiscard]] std::uint16_t height_at(const std::uint8_t* pixel);

}  // namespace terrella
