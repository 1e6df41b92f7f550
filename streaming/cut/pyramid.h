#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "streaming/cut/cut_plan.h"
#include "streaming/cut/strip.h"

namespace terrella {

/// Takes a picture's rows from the top and gives the strips of all levels, each as soon as its last row is known. Holds
/// one strip and two rows of each level.
///
/// A coarse pixel is the mean of the 2×2 finer ones weighted by their area on the sphere (streaming/cut/README.md).
/// Where a level's width is odd the last column's partner lies beyond +180°, which is the first column, or between the
/// first two where an earlier odd width has shifted them; longitude of x is that of x · 2^s modulo the picture's width.
/// Pixels of a strip outside the picture repeat its nearest row and column, or go round the planet.
/// thread: one at a time
class Pyramid {
 public:
  using TakeStrip = std::function<void(std::shared_ptr<const Strip>)>;
  Pyramid(const CutPlan& plan, bool has_alpha, StripPool& pool, TakeStrip take);

  /// The most that the strips under construction take together, and a finest strip alone.
  [[nodiscard]] static std::size_t strip_bytes(const CutPlan& plan);
  [[nodiscard]] static std::size_t finest_strip_bytes(const CutPlan& plan);

  /// Where the next row of the picture is to be written, 4 · width bytes; then row_written().
  [[nodiscard]] std::span<std::uint8_t> next_row();
  void row_written();

 private:
  /// What stands at a column beyond the last: (1 - share) of `column` and `share` of the one after it.
  struct WrappedColumn {
    std::int64_t column;
    float share;
  };
  struct Level {
    int level = 0;
    PixelRect px{};
    Strip shape;               ///< without pixels and row
    std::int64_t lead_px = 0;  ///< from the strip's first pixel to the picture's
    float first_cover = 1.0F;  ///< the part of the first and last column that the picture covers
    float last_cover = 1.0F;
    std::vector<WrappedColumn> beyond;  ///< from px.x1 on
    std::int64_t y = 0;                 ///< the next row
    std::shared_ptr<Strip> strip;
    std::array<std::vector<float>, 2> rows;  ///< the last even and odd row, premultiplied
    std::array<double, 2> areas{};
    [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(px.x1 - px.x0); }
  };

  [[nodiscard]] static Level make_level(const CutPlan& plan, int level);
  [[nodiscard]] static float cover(const CutPlan& plan, int level, std::int64_t x);
  [[nodiscard]] static WrappedColumn wrapped(const CutPlan& plan, int level, std::int64_t x);

  [[nodiscard]] std::uint8_t* strip_row(Level& level);
  void coarse_row_done(Level& level);
  void close_strip_row(Level& level);
  void pad_row(const Level& level, std::uint8_t* row) const;
  template <class T>
  void halve_into(const Level& from, const T* even, const T* odd, Level& to);
  template <class T>
  void mix_edge(const Level& from, const T* even, const T* odd, const std::array<float, 2>& weights,
                std::int64_t column, Level& to);
  template <class T>
  void halve_if_due(Level& from, const T* even, const T* odd);

  const CutPlan& plan_;
  bool has_alpha_;
  StripPool& pool_;
  TakeStrip take_;
  std::vector<Level> levels_;  ///< by level
};

}  // namespace terrella
