#include "streaming/warp/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace terrella {
namespace {

void paste_row(const Image& from, const BlockPart& part, int row, float* to) {
  const auto first = static_cast<std::size_t>(part.y + row) * static_cast<std::size_t>(from.width_px) +
                     static_cast<std::size_t>(part.x);
  const std::uint8_t* pixel = from.rgba.data() + 4 * first;
  for (int i = 0; i < part.width; ++i, pixel += 4, to += 4) {
    const float weight = static_cast<float>(pixel[3]) * (1.0F / 255.0F);
    to[0] = static_cast<float>(pixel[0]) * weight;
    to[1] = static_cast<float>(pixel[1]) * weight;
    to[2] = static_cast<float>(pixel[2]) * weight;
    to[3] = static_cast<float>(pixel[3]);
  }
}

void paste_row(const Numbers& from, const BlockPart& part, int row, float* to) {
  const auto first = static_cast<std::size_t>(part.y + row) * static_cast<std::size_t>(from.width_px) +
                     static_cast<std::size_t>(part.x);
  for (int i = 0; i < part.width; ++i, to += 2) {
    const float value = from.values[first + static_cast<std::size_t>(i)];
    const bool known = std::isfinite(value);
    to[0] = known ? value : 0.0F;
    to[1] = known ? 1.0F : 0.0F;
  }
}

/// Repeats the source's edge pixels beyond the edge.
template <std::size_t kChannels>
void repeat_edges(const WarpLevel& level, Canvas<kChannels>& canvas) {
  const PixelRect64& rect = canvas.rect;
  const auto bytes = static_cast<std::size_t>(rect.width()) * kChannels * sizeof(float);
  const std::int64_t top = std::clamp<std::int64_t>(-rect.v0, 0, rect.height());
  const std::int64_t bottom = std::clamp<std::int64_t>(level.rows() - rect.v0, 0, rect.height());
  if (top >= bottom) return;
  if (!level.area.is_cyclic()) {
    const std::int64_t left = std::clamp<std::int64_t>(-rect.u0, 0, rect.width());
    const std::int64_t right = std::clamp<std::int64_t>(level.columns() - rect.u0, 0, rect.width());
    if (left >= right) return;
    for (std::int64_t row = top; row < bottom; ++row) {
      for (std::int64_t i = 0; i < left; ++i) std::copy_n(canvas.at(left, row), kChannels, canvas.at(i, row));
      for (std::int64_t i = right; i < rect.width(); ++i) {
        std::copy_n(canvas.at(right - 1, row), kChannels, canvas.at(i, row));
      }
    }
  }
  for (std::int64_t row = 0; row < top; ++row) std::memcpy(canvas.at(0, row), canvas.at(0, top), bytes);
  for (std::int64_t row = bottom; row < rect.height(); ++row) {
    std::memcpy(canvas.at(0, row), canvas.at(0, bottom - 1), bytes);
  }
}

}  // namespace

template <std::size_t kChannels>
Result<Canvas<kChannels>, TileFailure> read_canvas(const WarpLevel& level, int index, const PixelRect64& rect,
                                                   const BlockAt& block_at) {
  using Pixels = std::conditional_t<kChannels == 4, Image, Numbers>;
  Canvas<kChannels> canvas{rect, {}};
  canvas.sums.resize(static_cast<std::size_t>(rect.width() * rect.height()) * kChannels);
  std::optional<TileFailure> failed;
  for_each_part(level, index, rect, [&](const BlockPart& part) {
    if (failed) return;
    const auto block = block_at(part.block);
    if (!block) failed = block.error();
    if (!block || !*block) return;
    const Pixels& pixels = std::get<Pixels>(**block);
    for (int row = 0; row < part.height; ++row) {
      paste_row(pixels, part, row, canvas.at(part.to_x, part.to_y + row));
    }
  });
  if (failed) return *failed;
  repeat_edges(level, canvas);
  return canvas;
}

template Result<ColourCanvas, TileFailure> read_canvas<4>(const WarpLevel&, int, const PixelRect64&, const BlockAt&);
template Result<NumberCanvas, TileFailure> read_canvas<2>(const WarpLevel&, int, const PixelRect64&, const BlockAt&);

}  // namespace terrella
