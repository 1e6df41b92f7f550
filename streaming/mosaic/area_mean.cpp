#include "streaming/mosaic/area_mean.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace terrella {
namespace {

constexpr std::size_t kColours = 4, kNumber = 2;
/// Weights that differ by less count as equal: rounding of sums.
constexpr float kRounding = 1e-4F;

/// Pixels of the result that a pixel of the file lies on: from `first` on, with the part on each.
struct Share {
  int first = 0;
  int count = 0;
  float parts[3] = {};
};

/// The shares of `count` pixels of a file, beginning with pixel `at`, on `side` pixels of the result.
std::vector<Share> shares(std::int64_t at, int count, double corner, double size, int side) {
  std::vector<Share> all(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double begin = std::max(corner + size * static_cast<double>(at + i), 0.0);
    const double end = std::min(corner + size * static_cast<double>(at + i + 1), static_cast<double>(side));
    if (end <= begin) continue;
    Share& share = all[static_cast<std::size_t>(i)];
    share.first = static_cast<int>(begin);
    for (int to = share.first; to < side && to < end && share.count < 3; ++to) {
      share.parts[share.count++] =
          static_cast<float>(std::min(end, to + 1.0) - std::max(begin, static_cast<double>(to)));
    }
  }
  return all;
}

/// Adds a pixel with a weight to a sum.
void add_pixel(const Image& image, std::size_t at, float weight, float* sum) {
  const std::uint8_t* pixel = image.rgba.data() + 4 * at;
  const float alpha = weight * static_cast<float>(pixel[3]) * (1.0F / 255.0F);
  for (std::size_t c = 0; c < 3; ++c) sum[c] += alpha * static_cast<float>(pixel[c]);
  sum[3] += alpha;
}
void add_pixel(const Numbers& numbers, std::size_t at, float weight, float* sum) {
  const float number = numbers.values[at];
  if (std::isnan(number)) return;
  sum[0] += weight * number;
  sum[1] += weight;
}

std::uint8_t as_byte(float value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F) + 0.5F); }

}  // namespace

AreaMean::AreaMean(const MeanBox& box, bool numbers)
    : box_(box),
      numbers_(numbers),
      channels_(numbers ? kNumber : kColours),
      file_(static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height) * channels_),
      total_(file_.size()) {}

template <class Pixels>
void AreaMean::add_rows(const Pixels& pixels, std::int64_t x, std::int64_t y, const PixelScale& scale) {
  const auto inside = [](int count, std::int64_t left) {
    return static_cast<int>(std::min<std::int64_t>(count, left));
  };
  const auto columns = shares(x, inside(pixels.width_px, scale.width_px - x),
                              scale.corner_x - static_cast<double>(box_.x), scale.size_x, box_.width);
  const auto rows = shares(y, inside(pixels.height_px, scale.height_px - y),
                           scale.corner_y - static_cast<double>(box_.y), scale.size_y, box_.height);
  const auto width = static_cast<std::size_t>(pixels.width_px);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (int r = 0; r < rows[row].count; ++r) {
      float* line = file_.data() + static_cast<std::size_t>((rows[row].first + r) * box_.width) * channels_;
      for (std::size_t column = 0; column < columns.size(); ++column) {
        const Share& share = columns[column];
        float* sum = line + static_cast<std::size_t>(share.first) * channels_;
        for (int c = 0; c < share.count; ++c, sum += channels_) {
          add_pixel(pixels, row * width + column, rows[row].parts[r] * share.parts[c], sum);
        }
      }
    }
  }
}

void AreaMean::add(const Block& block, std::int64_t x, std::int64_t y, const PixelScale& scale) {
  std::visit([&](const auto& pixels) { add_rows(pixels, x, y, scale); }, block);
}

void AreaMean::end_file() {
  const std::size_t last = channels_ - 1;
  for (std::size_t at = 0; at < file_.size(); at += channels_) {
    const float weight = file_[at + last];
    if (weight <= 0.0F) continue;
    const float part = std::min(1.0F, std::max(0.0F, 1.0F - total_[at + last]) / weight);
    for (std::size_t c = 0; c < channels_; ++c) total_[at + c] += part * file_[at + c];
  }
  std::ranges::fill(file_, 0.0F);
}

bool AreaMean::is_full() const {
  for (std::size_t at = channels_ - 1; at < total_.size(); at += channels_) {
    if (total_[at] < 1.0F - kRounding) return false;
  }
  return true;
}

Block AreaMean::finish() const {
  const std::size_t pixels = total_.size() / channels_;
  if (numbers_) {
    Numbers numbers{box_.width, box_.height, std::vector<float>(pixels, std::numeric_limits<float>::quiet_NaN())};
    for (std::size_t i = 0; i < pixels; ++i) {
      const float* sum = total_.data() + i * channels_;
      if (sum[1] >= 0.5F - kRounding) numbers.values[i] = sum[0] / sum[1];
    }
    return numbers;
  }
  Image image{box_.width, box_.height, std::vector<std::uint8_t>(pixels * 4)};
  for (std::size_t i = 0; i < pixels; ++i) {
    const float* sum = total_.data() + i * channels_;
    if (sum[3] <= 0.0F) continue;
    for (std::size_t c = 0; c < 3; ++c) image.rgba[4 * i + c] = as_byte(sum[c] / sum[3]);
    image.rgba[4 * i + 3] = as_byte(255.0F * sum[3]);
  }
  return image;
}

}  // namespace terrella
