#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace terrella {

enum class TiffColour { gray, gray_inverted, rgb, palette };
enum class TiffAlpha { none, straight, premultiplied };

/// Layout of the samples in a TIFF's pixels.
struct TiffSamples {
  TiffColour colour = TiffColour::rgb;
  TiffAlpha alpha = TiffAlpha::none;
  int bits = 8;                                      ///< bits per sample: 8 or 16
  std::size_t per_pixel = 3;                         ///< colours first, then alpha if present, then ignored samples
  std::vector<std::array<std::uint8_t, 3>> palette;  ///< 2^bits entries, for TiffColour::palette

  [[nodiscard]] std::size_t colours() const { return colour == TiffColour::rgb ? 3 : 1; }
  [[nodiscard]] std::size_t pixel_bytes() const { return per_pixel * static_cast<std::size_t>(bits) / 8; }
};

/// Converts `pixels` pixels to straight RGBA8; 16-bit samples are rounded to 8. thread: any
void to_rgba(const TiffSamples& samples, const std::uint8_t* from, std::size_t pixels, std::uint8_t* rgba);

}  // namespace terrella
