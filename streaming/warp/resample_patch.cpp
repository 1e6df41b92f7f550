#include "streaming/warp/resample_patch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>
#include <vector>

#include "streaming/warp/phase_table.h"
#include "streaming/warp/taps.h"
#include "streaming/warp/tile_pixels.h"

namespace terrella {
namespace {

/// Side of the squares of a tile with one shape of the filter.
constexpr int kSquare_px = 32;
/// Least height of a square for two passes.
constexpr int kLeast_px = 8;

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
    constexpr int kBits = 6;
    if (shape.length_u > 1.0) own_u_.emplace(shape.length_u, kBits);
    if (shape.length_v > 1.0) own_v_.emplace(shape.length_v, kBits);
    by_u_ = own_u_ ? &*own_u_ : &PhaseTable::plain();
    by_v_ = own_v_ ? &*own_v_ : &PhaseTable::plain();
  }

  /// The weighted sum around a place of the canvas.
  void sum(double u, double v, float* out) const {
    const Vector all = with_taps([&](auto taps) { return sum_rows<taps>(u, v); });
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

  /// The weighted sum along one row of the canvas.
  [[nodiscard]] Vector sum_row(double u, std::int64_t row) const {
    const PhaseTable::Taps columns = by_u_->at(u, canvas_.rect.width());
    const float* from = canvas_.at(columns.first, row);
    return with_taps([&](auto taps) { return this->row<taps>(columns, from); });
  }
  /// The rows around a place, and their number.
  [[nodiscard]] PhaseTable::Taps rows_at(double v) const { return by_v_->at(v, canvas_.rect.height()); }
  [[nodiscard]] bool leans() const { return shear_ != 0.0; }
  [[nodiscard]] int rows() const { return by_v_->taps(); }

 private:
  [[nodiscard]] PhaseTable::Taps columns_at(double u, double v, std::int64_t row) const {
    return by_u_->at(u + shear_ * (static_cast<double>(row) + 0.5 - v), canvas_.rect.width());
  }

  /// Calls `sum` with the number of columns as a constant for the usual filters, otherwise with 0.
  template <class Sum>
  [[nodiscard]] Vector with_taps(const Sum& sum) const {
    switch (by_u_->taps()) {
      case 4:
        return sum(std::integral_constant<int, 4>{});
      case 6:
        return sum(std::integral_constant<int, 6>{});
      case 8:
        return sum(std::integral_constant<int, 8>{});
      default:
        return sum(std::integral_constant<int, 0>{});
    }
  }

  /// `kTaps` is the number of columns, if the compiler is to know it; otherwise 0.
  template <int kTaps>
  [[nodiscard]] Vector sum_rows(double u, double v) const {
    const PhaseTable::Taps rows = by_v_->at(v, canvas_.rect.height());
    PhaseTable::Taps columns = columns_at(u, v, rows.first);
    Vector all{};
    for (int j = 0; j < by_v_->taps(); ++j) {
      if (shear_ != 0.0 && j > 0) columns = columns_at(u, v, rows.first + j);
      all += rows.weights[j] * row<kTaps>(columns, canvas_.at(columns.first, rows.first + j));
    }
    return all;
  }

  template <int kTaps>
  [[nodiscard]] Vector row(const PhaseTable::Taps& columns, const float* from) const {
    const int taps = kTaps > 0 ? kTaps : by_u_->taps();
    // Two sums, so that an addition need not wait for the one before.
    Vector even{}, odd{};
#pragma GCC unroll 4
    for (int i = 0; i < taps; i += 2, from += 2 * kChannels) {
      even += columns.weights[i] * load<kChannels>(from);
      odd += columns.weights[i + 1] * load<kChannels>(from + kChannels);
    }
    return even + odd;
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

/// True if the rows of the patch lie along rows of the source, within less than the map's own error, and neither far
/// apart nor close together there.
bool is_along_rows(const Patch& patch) {
  constexpr double kStraight_px = 0.005, kLeastRows = 0.5, kLeastSlopeOverBend = 8.0;
  double off = 0.0;
  for (const std::size_t i : {1, 2, 4, 5, 7, 8}) off += std::abs(patch.v[i]);
  return off <= kStraight_px && 2.0 * std::abs(patch.v[3]) >= kLeastRows * (patch.y1 - patch.y0) &&
         std::abs(patch.v[3]) >= kLeastSlopeOverBend * std::abs(patch.v[6]);
}

/// Rows of the source, resampled at the columns of a square. The columns of the square are then resampled from these
/// rows. Such two passes (Catmull and Smith 1980) need fewer sums than one. The filter leans along the columns.
template <std::size_t kChannels>
class SquareRows {
 public:
  using Vector = typename Lanes<kChannels>::Vector;

  SquareRows(const Sampler<kChannels>& sampler, const Patch& patch, const Square& square)
      : sampler_(sampler), width_(square.x1 - square.x0) {
    const double top = v_of(patch, square, square.y0 + 0.5), bottom = v_of(patch, square, square.y1 - 0.5);
    first_ = sampler.rows_at(std::min(top, bottom)).first;
    const std::int64_t end = sampler.rows_at(std::max(top, bottom)).first + sampler.rows();
    sums_.reserve(static_cast<std::size_t>((end - first_) * width_));
    const double step = 2.0 / (patch.x1 - patch.x0), s = patch.s_of(square.x0 + 0.5);
    double t = patch.t_of(square.y0 + 0.5);
    for (std::int64_t row = first_; row < end; ++row) {
      t = t_of(patch, static_cast<double>(row) + 0.5 - square.shift.y, t);
      const PatchRow places(patch, t);
      for (int x = 0; x < width_; ++x)
        sums_.push_back(sampler.sum_row(places.at(s + x * step).x + square.shift.x, row));
    }
  }

  void sum(int x, const PhaseTable::Taps& rows, float* out) const {
    const Vector* from = sums_.data() + (rows.first - first_) * width_ + x;
    Vector all{};
    for (int j = 0; j < sampler_.rows(); ++j, from += width_) all += rows.weights[j] * *from;
    std::memcpy(out, &all, sizeof(all));
  }

 private:
  static double v_of(const Patch& patch, const Square& square, double y) {
    const double t = patch.t_of(y);
    return (patch.v[6] * t + patch.v[3]) * t + patch.v[0] + square.shift.y;
  }
  /// Finds the place at which the patch reaches a row of the source, by Newton's method from a place near it.
  static double t_of(const Patch& patch, double v, double t) {
    for (int step = 0; step < 3; ++step) {
      t -= ((patch.v[6] * t + patch.v[3]) * t + patch.v[0] - v) / (2.0 * patch.v[6] * t + patch.v[3]);
    }
    return t;
  }

  const Sampler<kChannels>& sampler_;
  int width_;
  std::int64_t first_ = 0;
  std::vector<Vector> sums_;
};

template <class Tile>
void fill(const Patch& patch, const Square& square, const RasterArea& area, bool inside,
          const Canvas<Tile::kChannels>& canvas, typename Tile::Pixels& to) {
  const Sampler<Tile::kChannels> sampler(canvas, kernel_shape(square.slopes));
  std::optional<SquareRows<Tile::kChannels>> two_passes;
  if (is_along_rows(patch) && sampler.leans() && square.y1 - square.y0 >= kLeast_px) {
    two_passes.emplace(sampler, patch, square);
  }
  const double step = 2.0 / (patch.x1 - patch.x0), first = patch.s_of(0.5);
  for (int y = square.y0; y < square.y1; ++y) {
    const PatchRow row(patch, patch.t_of(y + 0.5));
    const PhaseTable::Taps rows = sampler.rows_at(row.at(0.0).y + square.shift.y);
    const std::size_t line = static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width_px);
    for (int x = square.x0; x < square.x1; ++x) {
      const CrsPoint at = row.at(first + x * step);
      const float coverage = inside ? 1.0F : coverage_at(at, area, square.slopes);
      if (coverage <= 0.0F) continue;
      float sum[Tile::kChannels] = {};
      if (two_passes) {
        two_passes->sum(x - square.x0, rows, sum);
      } else {
        sampler.sum(at.x + square.shift.x, at.y + square.shift.y, sum);
      }
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
