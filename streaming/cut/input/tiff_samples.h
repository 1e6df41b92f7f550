#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace terrella {

enum class TiffColour { gray, gray_inverted, rgb, palette };
enum class TiffAlpha { none, straight, premultiplied };

/// How the samples of a TIFF's pixels are to be read.
struct TiffSamples {
  TiffColour colour = TiffColour::rgb;
  TiffAlpha alpha = TiffAlpha::none;
  int bits = 8;               ///< of a sample: 8 or 16
  std::size_t per_pixel = 3;  ///< colours first, then alpha if there is any, then what is passed over
  std::vector<std::array<std::uint8_t, 3>> palette;  ///< 2^bits entries, for TiffColour::palette

  [[nodiscard]] std::size_t colours() const { return colour == TiffColour::rgb ? 3 : 1; }
  [[nodiscard]] std::size_t pixel_bytes() const { return per_pixel * static_cast<std::size_t>(bits) / 8; }
};

/// Turns `pixels` pixels into straight RGBA8, 16 bits rounded to 8. thread: any
void to_rgba(const TiffSamples& samples, const std::uint8_t* from, std::size_t pixels, std::uint8_t* rgba);

}  // namespace terrella
