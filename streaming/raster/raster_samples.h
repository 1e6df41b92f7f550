#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "streaming/numbers/stretch.h"

namespace terrella {

enum class RasterColour { gray, gray_inverted, rgb, palette };
enum class RasterAlpha { none, straight, premultiplied };
enum class SampleType { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64 };

[[nodiscard]] std::size_t sample_bytes(SampleType type);
/// One of three bands that are shown as red, green and blue.
struct BandStretch {
  std::size_t band = 0;  ///< index of the sample in its pixel
  Stretch stretch;
};

/// Layout and meaning of the samples of pixels: those of a pixel together, each of a type of this machine.
struct RasterSamples {
  RasterColour colour = RasterColour::rgb;
  RasterAlpha alpha = RasterAlpha::none;
  SampleType type = SampleType::uint8;
  int stored_bits = 8;                               ///< bits of a sample in the file, at most those of `type`
  std::size_t per_pixel = 3;                         ///< colours first, then alpha if present, then ignored samples
  std::vector<std::array<std::uint8_t, 4>> palette;  ///< colours of the indices, for RasterColour::palette
  std::optional<double> nodata = {};                 ///< a pixel whose colours all have this value is transparent
  /// Without it 16-bit samples are divided by 257. Samples with a sign, of 32 bits and floats need it.
  std::optional<Stretch> stretch = {};
  std::optional<std::array<BandStretch, 3>> composite = {};  ///< set: these bands are the colours; not for palettes

  [[nodiscard]] std::size_t colours() const { return colour == RasterColour::rgb ? 3 : 1; }
  [[nodiscard]] std::size_t pixel_bytes() const { return per_pixel * sample_bytes(type); }
  /// "12-bit unsigned integers"
  [[nodiscard]] std::string title() const;
  /// True if a pixel may be transparent.
  [[nodiscard]] bool may_be_clear() const;
};

/// Converts pixels to straight RGBA8. Makes tables once. thread: any, several at once
class ColourConverter {
 public:
  explicit ColourConverter(RasterSamples samples);
  [[nodiscard]] const RasterSamples& samples() const { return samples_; }
  void to_rgba(const std::uint8_t* from, std::size_t pixels, std::uint8_t* rgba) const;

 private:
  template <class T>
  void convert(const std::uint8_t* from, std::size_t pixels, std::uint8_t* rgba) const;
  template <class T>
  [[nodiscard]] std::uint8_t level(T value) const;
  [[nodiscard]] std::uint8_t level_of(double value) const;
  template <class T>
  void convert_composite(const std::uint8_t* from, std::size_t pixels, std::uint8_t* rgba) const;

  RasterSamples samples_;
  bool is_plain_rgb_ = false;         ///< three bytes that are the colours
  std::vector<std::uint8_t> levels_;  ///< result for each value of 8 or 16 bits, by its bits
};

/// Conversion of samples to physical numbers: value · scale + offset.
struct NumberCoding {
  std::size_t band = 0;  ///< index of the sample in its pixel
  std::optional<double> nodata = {};
  double scale = 1.0;
  double offset = 0.0;
};

/// Converts one sample of each pixel to a float. No data, NaN, infinite samples and pixels of alpha 0 give NaN. thread:
/// any
void to_floats(const RasterSamples& samples, const NumberCoding& coding, const std::uint8_t* from, std::size_t pixels,
               float* numbers);

/// One sample of a pixel as a double, which holds the values of every type exactly, integers of 64 bits up to 2^53.
/// thread: any
[[nodiscard]] double exact_sample(const RasterSamples& samples, std::size_t band, const std::uint8_t* pixel);

}  // namespace terrella
