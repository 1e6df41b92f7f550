#include "streaming/warp/filter/resample_patch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "streaming/warp/filter/sampler.h"
#include "streaming/warp/filter/taps.h"
#include "streaming/warp/filter/two_passes.h"
#include "streaming/warp/tile_pixels.h"

namespace terrella {
namespace {

/// Side of the squares of a tile with one shape of the filter.
constexpr int kSquare_px = 32;

bool is_inside(const Patch& patch, const RasterArea& area) {
  const PixelBox box = patch.box();
  double u = 0.0, v = 0.0;
  for (int k = 0; k < 4; ++k) {
    const Jacobian j = patch.jacobian(k % 2 * 2.0 - 1.0, k / 2 * 2.0 - 1.0);
    u = std::max(u, std::abs(j.u_x) + std::abs(j.u_y));
    v = std::max(v, std::abs(j.v_x) + std::abs(j.v_y));
  }
  const bool by_columns = area.is_cyclic() || (box.u0 > u && box.u1 < area.width_px - u);
  return by_columns && box.v0 > v && box.v1 < area.height_px - v;
}

float coverage_at(const CrsPoint& at, const RasterArea& area, const Jacobian& j) {
  const double by_columns = area.is_cyclic() ? 1.0 : covered(at.x, area.width_px, j.u_x, j.u_y);
  return static_cast<float>(by_columns * covered(at.y, area.height_px, j.v_x, j.v_y));
}

template <class Tile>
void fill(const Patch& patch, const Square& square, const RasterArea& area, bool inside,
          const Canvas<Tile::kChannels>& canvas, typename Tile::Pixels& to) {
  constexpr std::size_t kChannels = Tile::kChannels;
  const Sampler<kChannels> sampler(canvas, kernel_shape(square.slopes));
  const auto two_passes = TwoPasses<kChannels>::over(sampler, patch, square);
  const double step = 2.0 / (patch.x1 - patch.x0), first = patch.s_of(square.x0 + 0.5);
  std::array<float, kSquare_px * kChannels> sums{};
  for (int y = square.y0; y < square.y1; ++y) {
    const PatchRow row(patch, patch.t_of(y + 0.5));
    for (int i = 0; i < square.width(); ++i) {
      const CrsPoint at = row.at(first + i * step);
      const double u = at.x + square.shift.x, v = at.y + square.shift.y;
      float* sum = sums.data() + static_cast<std::size_t>(i) * kChannels;
      two_passes ? two_passes->sum(u, y, sum) : sampler.sum(u, v, sum);
      if (!Tile::is_whole(sum)) sampler.sum_positive(u, v, sum);
    }
    const auto line =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width_px) + static_cast<std::size_t>(square.x0);
    if (inside) {
      Tile::write_row(sums.data(), static_cast<std::size_t>(square.width()), to, line);
      continue;
    }
    for (int i = 0; i < square.width(); ++i) {
      const float coverage = coverage_at(row.at(first + i * step), area, square.slopes);
      if (coverage > 0.0F) {
        Tile::write(&sums[static_cast<std::size_t>(i) * kChannels], coverage, to, line + static_cast<std::size_t>(i));
      }
    }
  }
}

}  // namespace

template <class Tile>
void resample_patch(const Patch& patch, const RasterArea& area, const Canvas<Tile::kChannels>& canvas,
                    typename Tile::Pixels& to) {
  const bool inside = is_inside(patch, area);
  const double by_x = 2.0 / (patch.x1 - patch.x0), by_y = 2.0 / (patch.y1 - patch.y0);
  // The mean place of a pixel is off its middle by the map's bend.
  const auto bend = [&](const std::array<double, 9>& c) { return (c[2] * by_x * by_x + c[6] * by_y * by_y) / 12.0; };
  const CrsPoint shift{bend(patch.u) - static_cast<double>(canvas.rect.u0),
                       bend(patch.v) - static_cast<double>(canvas.rect.v0)};
  for (int y = patch.y0; y < patch.y1; y += kSquare_px) {
    for (int x = patch.x0; x < patch.x1; x += kSquare_px) {
      const int right = std::min(x + kSquare_px, patch.x1), lower = std::min(y + kSquare_px, patch.y1);
      const Square square{
          x, y, right, lower, patch.jacobian(patch.s_of(0.5 * (x + right)), patch.t_of(0.5 * (y + lower))), shift};
      fill<Tile>(patch, square, area, inside, canvas, to);
    }
  }
}

template void resample_patch<ColourTile>(const Patch&, const RasterArea&, const ColourCanvas&, Image&);
template void resample_patch<NumberTile>(const Patch&, const RasterArea&, const NumberCanvas&, Numbers&);

}  // namespace terrella
