#include "streaming/cut/input/heights.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace terrella {
namespace {

std::uint16_t whole_number(float height, std::optional<std::uint16_t> nodata) {
  const auto rounded = static_cast<std::uint16_t>(std::clamp(height, 0.0F, 65535.0F) + 0.5F);
  if (rounded != nodata) return rounded;
  return rounded == 65535 ? std::uint16_t{65534} : static_cast<std::uint16_t>(rounded + 1);
}

void put_height(std::uint16_t height, std::uint8_t* out) {
  std::memcpy(out, &height, sizeof(height));
  out[2] = out[3] = 0;
}

}  // namespace

std::uint16_t height_at(const std::uint8_t* pixel) {
  std::uint16_t height = 0;
  std::memcpy(&height, pixel, sizeof(height));
  return height;
}

void clear_height(std::optional<std::uint16_t> nodata, std::uint8_t* out) {
  if (nodata) put_height(*nodata, out);
}

float number_at(const std::uint8_t* pixel) {
  float number = 0.0F;
  std::memcpy(&number, pixel, sizeof(number));
  return number;
}

void put_number(float number, std::uint8_t* out) { std::memcpy(out, &number, sizeof(number)); }

void floats_to_numbers(std::span<const float> row, std::uint8_t* out) {
  for (std::size_t i = 0; i < row.size(); i += 4) {
    const bool known = row[i + 3] > 0.0F;
    put_number(known ? row[i] / row[i + 3] : std::numeric_limits<float>::quiet_NaN(), out + i);
  }
}

void mix_numbers(const std::uint8_t* a, const std::uint8_t* b, float share, std::uint8_t* out) {
  const float first = number_at(a);
  const float second = number_at(b);
  if (std::isnan(first) || std::isnan(second)) return put_number(std::isnan(first) ? second : first, out);
  put_number((1.0F - share) * first + share * second, out);
}

void heights_to_floats(std::span<const std::uint8_t> pixels, float* out) {
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    float height = 0.0F;
    std::memcpy(&height, pixels.data() + i, sizeof(height));
    const bool known = !std::isnan(height);
    out[i] = known ? height : 0.0F;
    out[i + 1] = out[i + 2] = 0.0F;
    out[i + 3] = known ? 1.0F : 0.0F;
  }
}

void floats_to_heights(std::span<const float> row, std::optional<std::uint16_t> nodata, std::uint8_t* out) {
  for (std::size_t i = 0; i < row.size(); i += 4) {
    const bool known = row[i + 3] > 0.0F;
    put_height(known ? whole_number(row[i] / row[i + 3], nodata) : nodata.value_or(0), out + i);
  }
}

void mix_heights(const std::uint8_t* a, const std::uint8_t* b, float share, std::optional<std::uint16_t> nodata,
                 std::uint8_t* out) {
  const std::uint16_t first = height_at(a);
  const std::uint16_t second = height_at(b);
  if (first == nodata || second == nodata) return put_height(first == nodata ? second : first, out);
  const float mixed = (1.0F - share) * static_cast<float>(first) + share * static_cast<float>(second);
  put_height(whole_number(mixed, nodata), out);
}

}  // namespace terrella
