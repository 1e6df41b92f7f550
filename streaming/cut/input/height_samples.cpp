#include "streaming/cut/input/height_samples.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace terrella {
namespace {

template <class T, class ToNumber>
void convert(const std::optional<double>& nodata, const std::uint8_t* samples, std::size_t pixel_bytes,
             std::size_t pixels, std::uint8_t* numbers, const ToNumber& to_number) {
  const bool may_lack = nodata.has_value();
  const T none = static_cast<T>(nodata.value_or(0.0));
  for (std::size_t i = 0; i < pixels; ++i, samples += pixel_bytes, numbers += 4) {
    T sample{};
    std::memcpy(&sample, samples, sizeof(sample));
    const float number = may_lack && sample == none ? std::numeric_limits<float>::quiet_NaN() : to_number(sample);
    std::memcpy(numbers, &number, sizeof(number));
  }
}

}  // namespace

void to_numbers(const HeightCoding& coding, const std::uint8_t* samples, std::size_t pixel_bytes, std::size_t pixels,
                std::uint8_t* numbers) {
  switch (coding.kind) {
    case HeightKind::uint16:
      return convert<std::uint16_t>(coding.nodata, samples, pixel_bytes, pixels, numbers,
                                    [](std::uint16_t sample) { return static_cast<float>(sample); });
    case HeightKind::int16:
      return convert<std::int16_t>(coding.nodata, samples, pixel_bytes, pixels, numbers,
                                   [](std::int16_t sample) { return static_cast<float>(sample + 32768); });
    case HeightKind::float32:
      return convert<float>(coding.nodata, samples, pixel_bytes, pixels, numbers, [&](float sample) {
        return static_cast<float>((static_cast<double>(sample) - coding.offset) / coding.scale);
      });
  }
}

}  // namespace terrella
