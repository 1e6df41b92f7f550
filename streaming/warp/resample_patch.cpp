#include "streaming/warp/resample_patch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "streaming/warp/taps.h"
#include "streaming/warp/tile_pixels.h"

namespace terrella {
namespace {

/// Side of the squares of a tile with one shape of the filter.
constexpr int kSquare_px = 32;

/// Weights of the pixels around a place, by the fraction of a pixel at which the place lies. The taps are even in
/// number.
class PhaseTable {
 public:
  /// Half a step of 1 / phases moves a picture by that much.
  PhaseTable(double length, int phases)
      : taps_(2 * static_cast<int>(std::ceil(2.0 * length))), phases_(phases), before_(2.0 * length - 0.5) {
    for (int phase = 0; phase <= phases; ++phase) {
      const std::size_t first = weights_.size();
      double all = 0.0;
      for (int i = 0; i < taps_; ++i) {
        const double weight = catmull_rom((i - static_cast<double>(phase) / phases - 2.0 * length + 1.0) / length);
        weights_.push_back(static_cast<float>(weight));
        all += weight;
      }
      for (std::size_t k = first; k < weights_.size(); ++k) weights_[k] = static_cast<float>(weights_[k] / all);
    }
  }
  static const PhaseTable& plain() {
    static const PhaseTable table(1.0, 512);
    return table;
  }

  struct Taps {
    std::int64_t first;
    const float* weights;
  };
  /// The taps around a place in `size` pixels. All of them lie inside.
  [[nodiscard]] Taps at(double place, std::int64_t size) const {
    const double from = std::clamp(place - before_, 0.0, static_cast<double>(size - taps_) - 1e-6);
    const auto first = static_cast<std::int64_t>(from);
    const auto phase = static_cast<std::int64_t>((from - static_cast<double>(first)) * phases_ + 0.5);
    return {first, weights_.data() + phase * taps_};
  }
  [[nodiscard]] int taps() const { return taps_; }

 private:
  int taps_;
  int phases_;
  double before_;  ///< from the first tap's outer edge to the place, at phase 0
  std::vector<float> weights_;
};

/// All channels of a pixel, summed at once.
template <std::size_t kChannels>
struct Lanes;
template <>
struct Lanes<4> {
  using Vector = float __attribute__((vector_size(16)));
};
template <>
struct Lanes<2> {
  using Vector = float __attribute__((vector_size(8)));
};
template <std::size_t kChannels>
typename Lanes<kChannels>::Vector load(const float* from) {
  typename Lanes<kChannels>::Vector lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

template <std::size_t kChannels>
class Sampler {
 public:
  using Vector = typename Lanes<kChannels>::Vector;

  Sampler(const Canvas<kChannels>& canvas, const KernelShape& shape) : canvas_(canvas), shear_(shape.shear) {
    constexpr int kPhases = 64;
    if (shape.length_u > 1.0) own_u_.emplace(shape.length_u, kPhases);
    if (shape.length_v > 1.0) own_v_.emplace(shape.length_v, kPhases);
    by_u_ = own_u_ ? &*own_u_ : &PhaseTable::plain();
    by_v_ = own_v_ ? &*own_v_ : &PhaseTable::plain();
  }

  /// The weighted sum around a place of the canvas.
  void sum(double u, double v, float* out) const {
    const Vector all = own_u_ || own_v_ ? shaped(u, v) : shear_ == 0.0 ? plain(u, v) : leaning(u, v);
    std::memcpy(out, &all, sizeof(all));
  }

  /// The same without negative weights.
  void sum_positive(double u, double v, float* out) const {
    Vector all{};
    float weights = 0.0F;
    const PhaseTable::Taps rows = by_v_->at(v, canvas_.rect.height());
    for (int j = 0; j < by_v_->taps(); ++j) {
      const PhaseTable::Taps columns = columns_at(u, v, rows.first + j);
      for (int i = 0; i < by_u_->taps(); ++i) {
        const float weight = std::max(rows.weights[j], 0.0F) * std::max(columns.weights[i], 0.0F);
        all += weight * load<kChannels>(canvas_.at(columns.first + i, rows.first + j));
        weights += weight;
      }
    }
    all *= weights > 0.0F ? 1.0F / weights : 0.0F;
    std::memcpy(out, &all, sizeof(all));
  }

 private:
  [[nodiscard]] PhaseTable::Taps columns_at(double u, double v, std::int64_t row) const {
    return by_u_->at(u + shear_ * (static_cast<double>(row) + 0.5 - v), canvas_.rect.width());
  }

  [[nodiscard]] Vector plain(double u, double v) const {
    const PhaseTable::Taps columns = by_u_->at(u, canvas_.rect.width()), rows = by_v_->at(v, canvas_.rect.height());
    const float* from = canvas_.at(columns.first, rows.first);
    const std::int64_t stride = canvas_.rect.width() * static_cast<std::int64_t>(kChannels);
    Vector all{};
    for (int j = 0; j < 4; ++j, from += stride) {
      Vector row{};
      for (std::size_t i = 0; i < 4; ++i) row += columns.weights[i] * load<kChannels>(from + i * kChannels);
      all += rows.weights[j] * row;
    }
    return all;
  }

  /// Four columns in four rows, which begin at places of their own.
  [[nodiscard]] Vector leaning(double u, double v) const {
    const PhaseTable::Taps rows = by_v_->at(v, canvas_.rect.height());
    Vector all{};
    for (int j = 0; j < 4; ++j) {
      const PhaseTable::Taps columns = columns_at(u, v, rows.first + j);
      const float* from = canvas_.at(columns.first, rows.first + j);
      Vector row{};
      for (std::size_t i = 0; i < 4; ++i) row += columns.weights[i] * load<kChannels>(from + i * kChannels);
      all += rows.weights[j] * row;
    }
    return all;
  }

  [[nodiscard]] Vector shaped(double u, double v) const {
    const PhaseTable::Taps rows = by_v_->at(v, canvas_.rect.height());
    Vector all{};
    for (int j = 0; j < by_v_->taps(); ++j) {
      const PhaseTable::Taps columns = columns_at(u, v, rows.first + j);
      const float* from = canvas_.at(columns.first, rows.first + j);
      // Two sums, so that an addition need not wait for the one before.
      Vector even{}, odd{};
      for (int i = 0; i < by_u_->taps(); i += 2, from += 2 * kChannels) {
        even += columns.weights[i] * load<kChannels>(from);
        odd += columns.weights[i + 1] * load<kChannels>(from + kChannels);
      }
      all += rows.weights[j] * (even + odd);
    }
    return all;
  }

  const Canvas<kChannels>& canvas_;
  const double shear_;
  std::optional<PhaseTable> own_u_, own_v_;
  const PhaseTable* by_u_;
  const PhaseTable* by_v_;
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

/// A row of a patch: the source pixel as a parabola over s.
struct PatchRow {
  PatchRow(const Patch& patch, double t) {
    for (std::size_t i = 0; i < 3; ++i) {
      u[i] = (patch.u[6 + i] * t + patch.u[3 + i]) * t + patch.u[i];
      v[i] = (patch.v[6 + i] * t + patch.v[3 + i]) * t + patch.v[i];
    }
  }
  [[nodiscard]] CrsPoint at(double s) const { return {(u[2] * s + u[1]) * s + u[0], (v[2] * s + v[1]) * s + v[0]}; }
  double u[3], v[3];
};

template <class Tile>
void fill(const Patch& patch, const Square& square, const RasterArea& area, bool inside,
          const Canvas<Tile::kChannels>& canvas, typename Tile::Pixels& to) {
  const Sampler<Tile::kChannels> sampler(canvas, kernel_shape(square.slopes));
  const double step = 2.0 / (patch.x1 - patch.x0), first = patch.s_of(0.5);
  for (int y = square.y0; y < square.y1; ++y) {
    const PatchRow row(patch, patch.t_of(y + 0.5));
    const std::size_t line = static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width_px);
    for (int x = square.x0; x < square.x1; ++x) {
      const CrsPoint at = row.at(first + x * step);
      const float coverage = inside ? 1.0F : coverage_at(at, area, square.slopes);
      if (coverage <= 0.0F) continue;
      float sum[Tile::kChannels] = {};
      sampler.sum(at.x + square.shift.x, at.y + square.shift.y, sum);
      if (!Tile::is_whole(sum)) sampler.sum_positive(at.x + square.shift.x, at.y + square.shift.y, sum);
      Tile::write(sum, coverage, to, line + static_cast<std::size_t>(x));
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
