#include "streaming/raster/raster_samples.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace terrella {
namespace {

/// Calls `use` with a value of the type of the samples.
template <class Use>
void with_sample_type(SampleType type, const Use& use) {
  switch (type) {
    case SampleType::uint8:
      return use(std::uint8_t{});
    case SampleType::int8:
      return use(std::int8_t{});
    case SampleType::uint16:
      return use(std::uint16_t{});
    case SampleType::int16:
      return use(std::int16_t{});
    case SampleType::uint32:
      return use(std::uint32_t{});
    case SampleType::int32:
      return use(std::int32_t{});
    case SampleType::uint64:
      return use(std::uint64_t{});
    case SampleType::int64:
      return use(std::int64_t{});
    case SampleType::float32:
      return use(float{});
    case SampleType::float64:
      return use(double{});
  }
}

template <class T>
T sample_at(const std::uint8_t* pixel, std::size_t index) {
  T value{};
  std::memcpy(&value, pixel + index * sizeof(T), sizeof(T));
  return value;
}

/// The value as a sample, if the type has it. A float is rounded, as GDAL's text of it may be longer.
template <class T>
std::optional<T> as_sample(std::optional<double> value) {
  if (!value) return {};
  if constexpr (std::is_integral_v<T>) {
    // The limit above the largest value is a power of two, which a double holds exactly.
    if (*value != std::round(*value) || *value < static_cast<double>(std::numeric_limits<T>::lowest()) ||
        *value >= std::ldexp(1.0, std::numeric_limits<T>::digits)) {
      return {};
    }
  } else if (std::abs(*value) > static_cast<double>(std::numeric_limits<T>::max())) {
    return {};
  }
  return static_cast<T>(*value);
}

std::uint8_t without_alpha(std::uint8_t colour, std::uint8_t alpha) {
  return alpha == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(std::min(255, (colour * 255 + alpha / 2) / alpha));
}

template <class T>
std::uint8_t alpha_level(T value, int stored_bits) {
  if constexpr (std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::uint16_t>) {
    const std::uint32_t most = (1U << stored_bits) - 1U;
    return static_cast<std::uint8_t>((value * 255U + most / 2U) / most);
  } else {
    return value > T{0} ? 255 : 0;
  }
}

}  // namespace

std::size_t sample_bytes(SampleType type) {
  std::size_t bytes = 0;
  with_sample_type(type, [&](auto value) { bytes = sizeof(value); });
  return bytes;
}

std::string RasterSamples::title() const {
  const std::string bits = std::to_string(stored_bits) + "-bit ";
  std::string kind;
  with_sample_type(type, [&](auto value) {
    using T = decltype(value);
    kind = std::is_floating_point_v<T> ? "floats" : std::is_signed_v<T> ? "signed integers" : "unsigned integers";
  });
  return bits + kind;
}

bool RasterSamples::may_be_clear() const {
  const auto is_clear = [](const auto& entry) { return entry[3] < 255; };
  return alpha != RasterAlpha::none || nodata || type == SampleType::float32 || type == SampleType::float64 ||
         std::ranges::any_of(palette, is_clear);
}

ColourConverter::ColourConverter(RasterSamples samples) : samples_(std::move(samples)) {
  is_plain_rgb_ = samples_.colour == RasterColour::rgb && samples_.per_pixel == 3 && samples_.stored_bits == 8 &&
                  samples_.type == SampleType::uint8 && !samples_.nodata && !samples_.stretch;
  if (samples_.colour == RasterColour::palette || samples_.composite) return;
  const auto fill = [this](auto zero) {
    using T = decltype(zero);
    if constexpr (sizeof(T) <= 2) {
      using Bits = std::make_unsigned_t<T>;
      levels_.resize(std::size_t{1} << (8 * sizeof(T)));
      for (std::size_t i = 0; i < levels_.size(); ++i) {
        levels_[i] = level_of(static_cast<double>(static_cast<T>(static_cast<Bits>(i))));
      }
    }
  };
  with_sample_type(samples_.type, fill);
}

std::uint8_t ColourConverter::level_of(double value) const {
  const double most = samples_.stored_bits <= 16 ? (1 << samples_.stored_bits) - 1.0 : 1.0;
  const Stretch range = samples_.stretch.value_or(Stretch{.low = 0.0, .high = most});
  // NaN, which infinite ranges give, becomes 0.
  const double share = std::min(1.0, std::max(0.0, (value - range.low) / (range.high - range.low)));
  const auto level = static_cast<std::uint8_t>(share * 255.0 + 0.5);
  return samples_.colour == RasterColour::gray_inverted ? static_cast<std::uint8_t>(255 - level) : level;
}

template <class T>
std::uint8_t ColourConverter::level(T value) const {
  if constexpr (sizeof(T) <= 2) {
    return levels_[static_cast<std::make_unsigned_t<T>>(value)];
  } else {
    return std::isfinite(static_cast<double>(value)) ? level_of(static_cast<double>(value)) : std::uint8_t{0};
  }
}

template <class T>
void ColourConverter::convert(const std::uint8_t* from, std::size_t pixels, std::uint8_t* rgba) const {
  const std::size_t step = samples_.pixel_bytes();
  const std::size_t colours = samples_.colours();
  const auto nodata = as_sample<T>(samples_.nodata);
  for (std::size_t i = 0; i < pixels; ++i, from += step, rgba += 4) {
    if (samples_.colour == RasterColour::palette) {
      const auto index = static_cast<std::size_t>(sample_at<T>(from, 0));
      std::memcpy(rgba, samples_.palette[std::min(index, samples_.palette.size() - 1)].data(), 4);
    } else {
      rgba[0] = level(sample_at<T>(from, 0));
      rgba[1] = colours == 3 ? level(sample_at<T>(from, 1)) : rgba[0];
      rgba[2] = colours == 3 ? level(sample_at<T>(from, 2)) : rgba[0];
    }
    if (samples_.alpha != RasterAlpha::none) {
      rgba[3] = alpha_level(sample_at<T>(from, colours), samples_.stored_bits);
    } else if (samples_.colour != RasterColour::palette) {
      rgba[3] = 255;
    }
    if (samples_.alpha == RasterAlpha::premultiplied) {
      for (std::size_t c = 0; c < 3; ++c) rgba[c] = without_alpha(rgba[c], rgba[3]);
    }
    bool clear = nodata.has_value();
    for (std::size_t c = 0; clear && c < colours; ++c) clear = sample_at<T>(from, c) == *nodata;
    if constexpr (std::is_floating_point_v<T>) clear = clear || std::isnan(sample_at<T>(from, 0));
    if (clear) std::memset(rgba, 0, 4);
  }
}

/// Bands of a composite are stretched without tables, because each band has a range of its own.
template <class T>
void ColourConverter::convert_composite(const std::uint8_t* from, std::size_t pixels, std::uint8_t* rgba) const {
  const auto nodata = as_sample<T>(samples_.nodata);
  const std::array<BandStretch, 3>& bands = *samples_.composite;
  for (std::size_t i = 0; i < pixels; ++i, from += samples_.pixel_bytes(), rgba += 4) {
    bool clear = nodata.has_value();
    bool unknown = false;
    for (std::size_t c = 0; c < 3; ++c) {
      const T sample = sample_at<T>(from, bands[c].band);
      const Stretch& range = bands[c].stretch;
      const double share = (static_cast<double>(sample) - range.low) / (range.high - range.low);
      rgba[c] = static_cast<std::uint8_t>(std::min(1.0, std::max(0.0, share)) * 255.0 + 0.5);
      clear = clear && sample == *nodata;
      if constexpr (std::is_floating_point_v<T>) unknown = unknown || std::isnan(sample);
    }
    rgba[3] = samples_.alpha == RasterAlpha::none
                  ? std::uint8_t{255}
                  : alpha_level(sample_at<T>(from, samples_.colours()), samples_.stored_bits);
    if (clear || unknown) std::memset(rgba, 0, 4);
  }
}

void ColourConverter::to_rgba(const std::uint8_t* from, std::size_t pixels, std::uint8_t* rgba) const {
  if (samples_.composite) {
    return with_sample_type(samples_.type, [&](auto zero) { convert_composite<decltype(zero)>(from, pixels, rgba); });
  }
  if (is_plain_rgb_) {
    for (std::size_t i = 0; i < pixels; ++i) {
      std::memcpy(rgba + 4 * i, from + 3 * i, 3);
      rgba[4 * i + 3] = 255;
    }
    return;
  }
  with_sample_type(samples_.type, [&](auto zero) { convert<decltype(zero)>(from, pixels, rgba); });
}

void to_floats(const RasterSamples& samples, const NumberCoding& coding, const std::uint8_t* from, std::size_t pixels,
               float* numbers) {
  with_sample_type(samples.type, [&](auto zero) {
    using T = decltype(zero);
    const auto nodata = as_sample<T>(coding.nodata);
    const std::size_t step = samples.pixel_bytes();
    for (std::size_t i = 0; i < pixels; ++i, from += step) {
      const T sample = sample_at<T>(from, coding.band);
      const auto number = static_cast<float>(static_cast<double>(sample) * coding.scale + coding.offset);
      const bool clear = samples.alpha != RasterAlpha::none && coding.band < samples.colours() &&
                         sample_at<T>(from, samples.colours()) == T{};
      const bool known = (!nodata || sample != *nodata) && !clear && std::isfinite(number);
      numbers[i] = known ? number : std::numeric_limits<float>::quiet_NaN();
    }
  });
}

double exact_sample(const RasterSamples& samples, std::size_t band, const std::uint8_t* pixel) {
  double exact = 0.0;
  with_sample_type(samples.type,
                   [&](auto zero) { exact = static_cast<double>(sample_at<decltype(zero)>(pixel, band)); });
  return exact;
}

}  // namespace terrella
