#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "streaming/warp/filter/sampler.h"
#include "streaming/warp/map/patch.h"

namespace terrella {

/// A square of a patch: its filter, and where its pixels lie in the canvas.
struct Square {
  int x0, y0, x1, y1;
  Jacobian slopes;
  CrsPoint shift;  ///< from a pixel's middle to the mean place of the pixel, and to the canvas' corner
  [[nodiscard]] int width() const { return x1 - x0; }
};

/// Finds where the columns of a square meet rows of the canvas: a patch over the square's columns and the rows
/// [first, end), whose u is the column of the canvas. None if a patch does not follow that curve. thread: any
[[nodiscard]] std::optional<Patch> column_curves(const Patch& patch, const Square& square, std::int64_t first,
                                                 std::int64_t end);

/// True if the filter of a square may lean along its columns, which two passes make it do. thread: any
[[nodiscard]] bool suits_two_passes(const Square& square, double shear);

/// Rows of the canvas, resampled at the columns of a square. The columns of the square are then resampled from these
/// rows. Such two passes (Catmull and Smith 1980) need fewer sums than one. thread: any
template <std::size_t kChannels>
class TwoPasses {
 public:
  using Vector = typename Lanes<kChannels>::Vector;

  /// None if the square does not suit.
  [[nodiscard]] static std::optional<TwoPasses> over(const Sampler<kChannels>& sampler, const Patch& patch,
                                                     const Square& square) {
    if (!suits_two_passes(square, sampler.shear())) return {};
    const PixelBox box = patch.part(square.x0, square.y0, square.x1, square.y1).box();
    constexpr double kRounding_px = 1e-3;
    const std::int64_t first = sampler.rows_at(box.v0 + square.shift.y - kRounding_px).first;
    const std::int64_t end = sampler.rows_at(box.v1 + square.shift.y + kRounding_px).first + sampler.rows();
    const auto curves = column_curves(patch, square, first, end);
    if (!curves) return {};
    return TwoPasses(sampler, *curves);
  }

  /// The sum of a column of the square over rows of the canvas.
  void sum(int x, const PhaseTable::Taps& rows, float* out) const {
    const Vector all = sampler_.sum_weighted(rows.weights, sums_.data() + (rows.first - first_) * width_ + x, width_);
    std::memcpy(out, &all, sizeof(all));
  }

 private:
  TwoPasses(const Sampler<kChannels>& sampler, const Patch& curves)
      : sampler_(sampler), width_(curves.x1 - curves.x0), first_(curves.y0) {
    sums_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(curves.y1 - curves.y0));
    Vector* out = sums_.data();
    for (int row = curves.y0; row < curves.y1; ++row, out += width_) {
      const PatchRow columns(curves, curves.t_of(row + 0.5));
      sampler.sum_row(columns, curves.s_of(curves.x0 + 0.5), 2.0 / width_, row, width_, out);
    }
  }

  const Sampler<kChannels>& sampler_;
  int width_;
  std::int64_t first_;
  std::vector<Vector> sums_;
};

}  // namespace terrella
