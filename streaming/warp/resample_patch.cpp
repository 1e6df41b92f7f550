#include "streaming/warp/resample_patch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "streaming/warp/taps.h"
#include "streaming/warp/tile_pixels.h"

namespace terrella {
namespace {

/// Pixels of a tile with one shape of the filter.
constexpr int kSquare_px = 16;
/// Steps of the tables per source pixel. Half a step moves a picture by a thousandth of a pixel.
constexpr int kPhases = 512;

/// Weights of four pixels around a place at a fraction of a pixel after the middle of the second.
const std::array<std::array<float, 4>, kPhases + 1>& plain_weights() {
  static const auto table = [] {
    std::array<std::array<float, 4>, kPhases + 1> made{};
    for (int k = 0; k <= kPhases; ++k) {
      for (int i = 0; i < 4; ++i) {
        made[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)] =
            static_cast<float>(catmull_rom(i - 1.0 - static_cast<double>(k) / kPhases));
      }
    }
    return made;
  }();
  return table;
}

/// The cubic at multiples of 1 / kPhases.
const std::array<float, 2 * kPhases + 2>& cubic_table() {
  static const auto table = [] {
    std::array<float, 2 * kPhases + 2> made{};
    for (int k = 0; k <= 2 * kPhases; ++k) {
      made[static_cast<std::size_t>(k)] = static_cast<float>(catmull_rom(static_cast<double>(k) / kPhases));
    }
    return made;
  }();
  return table;
}

struct Rows {
  std::int64_t first, last;
};
Rows reached(double middle, double length, std::int64_t size) {
  const auto clamped = [size](double at) {
    return static_cast<std::int64_t>(std::clamp(at, 0.0, static_cast<double>(size - 1)));
  };
  return {clamped(std::ceil(middle - 0.5 - 2.0 * length)), clamped(std::floor(middle - 0.5 + 2.0 * length))};
}

template <std::size_t kChannels>
class Sampler {
 public:
  Sampler(const Canvas<kChannels>& canvas, const KernelShape& shape)
      : canvas_(canvas), shape_(shape), plain_(plain_weights()), cubic_(cubic_table()) {}

  /// The weighted sum around a place of the canvas. `least` is the smallest weight that counts.
  void sum(double u, double v, float least, float* out) const {
    shape_.is_plain ? sum_plain(u, v, least, out) : sum_shape(u, v, least, out);
  }

 private:
  struct Phase {
    std::int64_t first;
    std::size_t step;
  };
  static Phase phase(double at, std::int64_t size) {
    const double from = std::clamp(at - 0.5, 1.0, static_cast<double>(size) - 3.0);
    const double whole = std::floor(from);
    return {static_cast<std::int64_t>(whole) - 1, static_cast<std::size_t>((from - whole) * kPhases + 0.5)};
  }

  void sum_plain(double u, double v, float least, float* out) const {
    const Phase column = phase(u, canvas_.rect.width()), row = phase(v, canvas_.rect.height());
    const auto &by_u = plain_[column.step], &by_v = plain_[row.step];
    const auto stride = static_cast<std::size_t>(canvas_.rect.width()) * kChannels;
    const float* from = canvas_.at(column.first, row.first);
    float all[kChannels] = {};
    float weights = 0.0F;
    for (std::size_t j = 0; j < 4; ++j, from += stride) {
      for (std::size_t i = 0; i < 4; ++i) {
        const float weight = std::max(by_v[j] * by_u[i], least);
        for (std::size_t c = 0; c < kChannels; ++c) all[c] += weight * from[i * kChannels + c];
        weights += weight;
      }
    }
    const float scale = 1.0F / weights;
    for (std::size_t c = 0; c < kChannels; ++c) out[c] = all[c] * scale;
  }

  [[nodiscard]] float weight(double distance) const {
    const double at = std::abs(distance) * kPhases + 0.5;
    return at < 2.0 * kPhases + 1.0 ? cubic_[static_cast<std::size_t>(at)] : 0.0F;
  }

  void sum_shape(double u, double v, float least, float* out) const {
    float all[kChannels] = {};
    float weights = 0.0F;
    const Rows rows = reached(v, shape_.length_v, canvas_.rect.height());
    const double by_u = 1.0 / shape_.length_u, by_v = 1.0 / shape_.length_v;
    for (std::int64_t row = rows.first; row <= rows.last; ++row) {
      const double down = static_cast<double>(row) + 0.5 - v;
      const double middle = u + shape_.shear * down;
      const float row_weight = weight(down * by_v);
      const Rows columns = reached(middle, shape_.length_u, canvas_.rect.width());
      const float* from = canvas_.at(columns.first, row);
      for (std::int64_t column = columns.first; column <= columns.last; ++column, from += kChannels) {
        const float weighed = std::max(row_weight * weight((static_cast<double>(column) + 0.5 - middle) * by_u), least);
        for (std::size_t c = 0; c < kChannels; ++c) all[c] += weighed * from[c];
        weights += weighed;
      }
    }
    const float scale = weights > 1e-6F ? 1.0F / weights : 0.0F;
    for (std::size_t c = 0; c < kChannels; ++c) out[c] = all[c] * scale;
  }

  const Canvas<kChannels>& canvas_;
  const KernelShape shape_;
  const std::array<std::array<float, 4>, kPhases + 1>& plain_;
  const std::array<float, 2 * kPhases + 2>& cubic_;
};

/// A square of a patch: its filter, and where its pixels lie in the canvas.
struct Square {
  int x0, y0, x1, y1;
  Jacobian slopes;
  CrsPoint shift;  ///< from a pixel's middle to the mean place of the pixel, and to the canvas' corner
};

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
  const Sampler<Tile::kChannels> sampler(canvas, kernel_shape(square.slopes));
  constexpr float kAll = -1e9F;
  for (int y = square.y0; y < square.y1; ++y) {
    const double t = patch.t_of(y + 0.5);
    for (int x = square.x0; x < square.x1; ++x) {
      const CrsPoint at = patch.at(patch.s_of(x + 0.5), t);
      const float coverage = inside ? 1.0F : coverage_at(at, area, square.slopes);
      if (coverage <= 0.0F) continue;
      float sum[Tile::kChannels];
      sampler.sum(at.x + square.shift.x, at.y + square.shift.y, kAll, sum);
      if (!Tile::is_whole(sum)) sampler.sum(at.x + square.shift.x, at.y + square.shift.y, 0.0F, sum);
      Tile::write(sum, coverage, to,
                  static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width_px) + static_cast<std::size_t>(x));
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
