#include "streaming/mercator/resample.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace terrella {
namespace {

constexpr std::size_t kChannels = 4;

/// Enlarges the part of a picture over a piece to a whole tile. Uses pixels beyond the edge of the part if the picture
/// has them.
Image enlarged(const PiecePicture& piece, int tile_px) {
  const Image& from = *piece.picture;
  const double scale = std::ldexp(1.0, -piece.steps);
  const auto place = [&](std::int64_t part, int i) {
    return std::clamp((static_cast<double>(part) * tile_px + i + 0.5) * scale - 0.5, 0.0, tile_px - 1.0);
  };
  Image to{tile_px, tile_px, std::vector<std::uint8_t>(from.rgba.size())};
  const auto texel = [&](int x, int y) {
    const auto at = static_cast<std::size_t>(std::min(y, tile_px - 1) * tile_px + std::min(x, tile_px - 1));
    return from.rgba.data() + at * kChannels;
  };
  for (int j = 0; j < tile_px; ++j) {
    const double v = place(piece.part_y, j);
    const int y = static_cast<int>(v);
    for (int i = 0; i < tile_px; ++i) {
      const double u = place(piece.part_x, i);
      const int x = static_cast<int>(u);
      std::uint8_t* out = to.rgba.data() + static_cast<std::size_t>(j * tile_px + i) * kChannels;
      for (std::size_t c = 0; c < kChannels; ++c) {
        const double upper = std::lerp(double(texel(x, y)[c]), double(texel(x + 1, y)[c]), u - x);
        const double lower = std::lerp(double(texel(x, y + 1)[c]), double(texel(x + 1, y + 1)[c]), u - x);
        out[c] = static_cast<std::uint8_t>(std::lerp(upper, lower, v - y) + 0.5);
      }
    }
  }
  return to;
}

/// Texels of all pieces side by side.
struct Canvas {
  std::size_t columns = 0;
  std::vector<std::uint8_t> rgba;
  [[nodiscard]] const std::uint8_t* row(std::size_t y) const { return rgba.data() + y * columns * kChannels; }
};

void paste(const Image& from, const MercatorPiece& piece, const MercatorPlan& plan, Canvas& canvas) {
  const std::int64_t left = std::max<std::int64_t>(piece.first_column, 0);
  const std::int64_t right = std::min<std::int64_t>(piece.first_column + plan.tile_px, plan.columns);
  const std::int64_t top = std::max<std::int64_t>(piece.first_row, 0);
  const std::int64_t bottom = std::min<std::int64_t>(piece.first_row + plan.tile_px, plan.rows);
  if (left >= right) return;
  for (std::int64_t y = top; y < bottom; ++y) {
    const std::int64_t at = (y - piece.first_row) * plan.tile_px + left - piece.first_column;
    std::memcpy(canvas.rgba.data() + static_cast<std::size_t>(y * plan.columns + left) * kChannels,
                from.rgba.data() + static_cast<std::size_t>(at) * kChannels,
                static_cast<std::size_t>(right - left) * kChannels);
  }
}

Canvas canvas_of(const MercatorPlan& plan, const std::vector<PiecePicture>& pictures) {
  Canvas canvas{static_cast<std::size_t>(plan.columns), {}};
  canvas.rgba.resize(canvas.columns * static_cast<std::size_t>(plan.rows) * kChannels);
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    if (!pictures[i].picture) continue;
    assert(pictures[i].picture->rgba.size() ==
           static_cast<std::size_t>(plan.tile_px) * static_cast<std::size_t>(plan.tile_px) * kChannels);
    if (pictures[i].steps == 0) {
      paste(*pictures[i].picture, plan.pieces[i], plan, canvas);
    } else {
      paste(enlarged(pictures[i], plan.tile_px), plan.pieces[i], plan, canvas);
    }
  }
  return canvas;
}

/// Colours times alpha / 255, exact to 1/510.
void premultiply_all(Canvas& canvas) {
  for (std::size_t i = 0; i < canvas.rgba.size(); i += kChannels) {
    const unsigned alpha = canvas.rgba[i + 3];
    if (alpha == 255) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      canvas.rgba[i + c] = static_cast<std::uint8_t>((canvas.rgba[i + c] * alpha + 127U) / 255U);
    }
  }
}

void sum_rows(const Canvas& canvas, const Taps& taps, std::vector<float>& sums) {
  std::fill(sums.begin(), sums.end(), 0.0F);
  for (std::size_t k = 0; k < taps.weights.size(); ++k) {
    const float weight = taps.weights[k];
    const std::uint8_t* row = canvas.row(static_cast<std::size_t>(taps.first) + k);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += weight * static_cast<float>(row[i]);
  }
}

std::uint8_t as_byte(float value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F) + 0.5F); }

void write_texel(const float* sums, const Taps& taps, float coverage, std::uint8_t* out) {
  float sum[kChannels] = {};
  const float* from = sums + static_cast<std::size_t>(taps.first) * kChannels;
  for (const float weight : taps.weights) {
    for (std::size_t c = 0; c < kChannels; ++c) sum[c] += weight * from[c];
    from += kChannels;
  }
  if (sum[3] < 0.5F) return;
  const float to_plain = sum[3] > 254.5F ? 1.0F : 255.0F / sum[3];
  for (std::size_t c = 0; c < 3; ++c) out[c] = as_byte(sum[c] * to_plain);
  out[3] = as_byte(std::min(sum[3], 255.0F) * coverage);
}

}  // namespace

Image resample(const MercatorPlan& plan, const std::vector<PiecePicture>& pictures) {
  assert(pictures.size() == plan.pieces.size());
  const auto side = static_cast<std::size_t>(plan.tile_px);
  Image image{plan.tile_px, plan.tile_px, std::vector<std::uint8_t>(side * side * kChannels)};
  Canvas canvas = canvas_of(plan, pictures);
  premultiply_all(canvas);
  std::vector<float> sums(canvas.columns * kChannels);
  for (std::size_t y = 0; y < side; ++y) {
    const RowTaps& row = plan.row_taps[y];
    if (row.coverage <= 0.0F || row.taps.weights.empty()) continue;
    sum_rows(canvas, row.taps, sums);
    std::uint8_t* out = image.rgba.data() + y * side * kChannels;
    for (std::size_t x = 0; x < side; ++x) {
      write_texel(sums.data(), plan.column_taps[x], row.coverage, out + x * kChannels);
    }
  }
  return image;
}

}  // namespace terrella
