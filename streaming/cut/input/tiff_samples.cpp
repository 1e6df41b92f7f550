#include "streaming/cut/input/tiff_samples.h"

#include <algorithm>
#include <cstring>

namespace terrella {
namespace {

std::uint8_t sample(const std::uint8_t* pixel, std::size_t index, std::uint8_t) { return pixel[index]; }

/// 65535 is 255 · 257. libtiff has already converted the bytes to this machine's order.
std::uint8_t sample(const std::uint8_t* pixel, std::size_t index, std::uint16_t) {
  std::uint16_t value = 0;
  std::memcpy(&value, pixel + 2 * index, 2);
  return static_cast<std::uint8_t>((value + 128U) / 257U);
}

std::uint8_t unpremultiplied(std::uint8_t colour, std::uint8_t alpha) {
  return alpha == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(std::min(255, (colour * 255 + alpha / 2) / alpha));
}

template <class T>
void colour_to_rgb(const TiffSamples& samples, const std::uint8_t* pixel, std::uint8_t* rgb) {
  switch (samples.colour) {
    case TiffColour::rgb:
      for (std::size_t c = 0; c < 3; ++c) rgb[c] = sample(pixel, c, T{});
      return;
    case TiffColour::gray:
      std::memset(rgb, sample(pixel, 0, T{}), 3);
      return;
    case TiffColour::gray_inverted:
      std::memset(rgb, 255 - sample(pixel, 0, T{}), 3);
      return;
    case TiffColour::palette: {
      T index{};
      std::memcpy(&index, pixel, sizeof(T));
      std::memcpy(rgb, samples.palette[index].data(), 3);
      return;
    }
  }
}

template <class T>
void convert(const TiffSamples& samples, const std::uint8_t* from, std::size_t pixels, std::uint8_t* rgba) {
  const std::size_t step = samples.pixel_bytes();
  for (std::size_t i = 0; i < pixels; ++i, from += step, rgba += 4) {
    colour_to_rgb<T>(samples, from, rgba);
    rgba[3] = samples.alpha == TiffAlpha::none ? std::uint8_t{255} : sample(from, samples.colours(), T{});
    if (samples.alpha != TiffAlpha::premultiplied) continue;
    for (std::size_t c = 0; c < 3; ++c) rgba[c] = unpremultiplied(rgba[c], rgba[3]);
  }
}

}  // namespace

void to_rgba(const TiffSamples& samples, const std::uint8_t* from, std::size_t pixels, std::uint8_t* rgba) {
  samples.bits == 16 ? convert<std::uint16_t>(samples, from, pixels, rgba)
                     : convert<std::uint8_t>(samples, from, pixels, rgba);
}

}  // namespace terrella
