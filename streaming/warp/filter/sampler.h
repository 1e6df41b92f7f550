#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

#include "streaming/warp/canvas.h"
#include "streaming/warp/filter/lanes.h"
#include "streaming/warp/filter/phase_table.h"
#include "streaming/warp/filter/taps.h"
#include "streaming/warp/map/patch.h"

namespace terrella {

/// Weighted sums of a canvas under one shape of the filter. thread: any
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
    Vector all;
    with_taps(by_u_->taps(), [&](auto taps) { all = sum_rows<taps>(u, v); });
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

  /// The weighted sums along columns of the canvas, `count` from `column` on, at rows that a row of a patch has from
  /// `s` on.
  void sum_rows(const PatchRow& rows, double s, double step, std::int64_t column, int count, Vector* out) const {
    const std::int64_t height = canvas_.rect.height();
    const std::ptrdiff_t stride = canvas_.rect.width() * std::ptrdiff_t{kChannels};
    with_taps(by_v_->taps(), [&](auto taps) {
      for (int x = 0; x < count; ++x) {
        const PhaseTable::Taps at = by_v_->at(rows.at(s + x * step).y, height);
        out[x] = strided<taps>(at.weights, canvas_.at(column + x, at.first), stride);
      }
    });
  }
  /// The weighted sum of vectors side by side.
  [[nodiscard]] Vector sum_columns(const PhaseTable::Taps& columns, const Vector* from) const {
    Vector all{};
    with_taps(by_u_->taps(), [&](auto taps) {
      const int count = taps > 0 ? taps : by_u_->taps();
      for (int i = 0; i < count; ++i) all += columns.weights[i] * from[i];
    });
    return all;
  }
  /// The columns around a place of a filter without shear, and their number.
  [[nodiscard]] PhaseTable::Taps columns_at(double u) const { return by_u_->at(u, canvas_.rect.width()); }
  [[nodiscard]] int columns() const { return by_u_->taps(); }
  /// Columns by which the filter moves from row to row.
  [[nodiscard]] double shear() const { return shear_; }

 private:
  [[nodiscard]] PhaseTable::Taps columns_at(double u, double v, std::int64_t row) const {
    return by_u_->at(u + shear_ * (static_cast<double>(row) + 0.5 - v), canvas_.rect.width());
  }

  /// Calls `work` with the number of taps as a constant for the usual filters, otherwise with 0.
  template <class Work>
  static void with_taps(int taps, const Work& work) {
    switch (taps) {
      case 4:
        return work(std::integral_constant<int, 4>{});
      case 6:
        return work(std::integral_constant<int, 6>{});
      case 8:
        return work(std::integral_constant<int, 8>{});
      default:
        return work(std::integral_constant<int, 0>{});
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
  [[nodiscard]] Vector strided(const float* weights, const float* from, std::ptrdiff_t stride) const {
    const int taps = kTaps > 0 ? kTaps : by_v_->taps();
    Vector all{};
    for (int j = 0; j < taps; ++j, from += stride) all += weights[j] * load<kChannels>(from);
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

}  // namespace terrella
