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

/// Finds where the rows of a square meet columns of the canvas: a patch over the columns [first, end) and the square's
/// rows, whose v is the row of the canvas. None if a patch does not follow that curve. thread: any
[[nodiscard]] std::optional<Patch> row_curves(const Patch& patch, const Square& square, std::int64_t first,
                                              std::int64_t end);

/// True if the filter of a square may lean along its rows, which two passes make it do. thread: any
[[nodiscard]] bool suits_two_passes(const Square& square, double shear);

/// Columns of the canvas, resampled at the rows of a square. The rows of the square are then resampled from these
/// columns. Such two passes (Catmull and Smith 1980) need fewer sums than one. thread: any
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
    const std::int64_t first = sampler.columns_at(box.u0 + square.shift.x - kRounding_px).first;
    const std::int64_t end = sampler.columns_at(box.u1 + square.shift.x + kRounding_px).first + sampler.columns();
    const auto curves = row_curves(patch, square, first, end);
    if (!curves) return {};
    return TwoPasses(sampler, *curves);
  }

  /// The sum around a column of the canvas, in a row of the square.
  void sum(double u, int y, float* out) const {
    const PhaseTable::Taps columns = sampler_.columns_at(u);
    const Vector all = sampler_.sum_columns(columns, sums_.data() + (y - row_) * width_ + columns.first - first_);
    std::memcpy(out, &all, sizeof(all));
  }

 private:
  TwoPasses(const Sampler<kChannels>& sampler, const Patch& curves)
      : sampler_(sampler), width_(curves.x1 - curves.x0), first_(curves.x0), row_(curves.y0) {
    sums_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(curves.y1 - curves.y0));
    Vector* out = sums_.data();
    for (int y = curves.y0; y < curves.y1; ++y, out += width_) {
      const PatchRow rows(curves, curves.t_of(y + 0.5));
      sampler.sum_rows(rows, curves.s_of(curves.x0 + 0.5), 2.0 / width_, first_, width_, out);
    }
  }

  const Sampler<kChannels>& sampler_;
  int width_;
  std::int64_t first_;
  int row_;
  std::vector<Vector> sums_;
};

}  // namespace terrella
