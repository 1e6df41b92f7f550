#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "streaming/cut/cut_plan.h"
#include "streaming/cut/strip.h"

namespace terrella {

/// What the four bytes of a pixel in a strip are.
enum class PixelKind {
  opaque,  ///< RGBA8, every alpha 255
  alpha,   ///< RGBA8, not premultiplied
  height,  ///< as read: a 32-bit float, NaN where there is none; in a finished row: 16 bits
           ///< (streaming/cut/input/heights.h)
};

/// The part of a pyramid that one Pyramid makes.
struct PyramidPart {
  int coarsest = 0;
  int finest = 0;
  std::int64_t first_row = 0;  ///< at the finest of these levels; a multiple of tile_px · 2^(finest - coarsest), or
                               ///< above the picture
  PixelKind pixels = PixelKind::opaque;
  std::optional<std::uint16_t> nodata = {};  ///< of heights
};

/// Takes rows from the top and gives the strips of a part's levels, each as soon as its last row is known, and the rows
/// of the level above, from which another Pyramid goes on to the same bytes. Holds one strip and two rows of each
/// level.
///
/// A coarse pixel is the mean of the 2×2 finer ones weighted by their area on the sphere (streaming/cut/README.md).
/// Where a level's width is odd the last column's partner lies beyond +180°, which is the first column, or between the
/// first two where an earlier odd width has shifted them; longitude of x is that of x · 2^s modulo the picture's width.
/// Pixels of a strip outside the picture repeat its nearest row and column, or go round the planet.
/// thread: one at a time
class Pyramid {
 public:
  using TakeStrip = std::function<void(std::shared_ptr<const Strip>)>;
  /// A row of the level above the coarsest as floats, premultiplied, with its area.
  using TakeRow = std::function<void(double area, std::span<const float> row)>;
  Pyramid(const CutPlan& plan, const PyramidPart& part, StripPool& pool, TakeStrip take_strip, TakeRow take_row);

  /// The most that the strips under construction take together, and a finest strip alone.
  [[nodiscard]] static std::size_t strip_bytes(const CutPlan& plan, const PyramidPart& part);
  [[nodiscard]] static std::size_t finest_strip_bytes(const CutPlan& plan);
  /// Floats in a row that another part gives for this level.
  [[nodiscard]] static std::size_t row_floats(const CutPlan& plan, int level);

  /// Where the next row of the picture is to be written, 4 · width bytes; then row_written(). For a part that has the
  /// picture's finest level.
  [[nodiscard]] std::span<std::uint8_t> next_row();
  void row_written();
  /// The next row of the finest of these levels, from the part below.
  void put_row(double area, std::span<const float> row);

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

  [[nodiscard]] Level& above(const Level& level);
  void to_pixels(std::span<const float> row, std::uint8_t* out) const;
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
  PyramidPart part_;
  StripPool& pool_;
  TakeStrip take_strip_;
  TakeRow take_row_;
  std::vector<Level> levels_;  ///< from the coarsest
  Level above_coarsest_;       ///< rows alone
};

}  // namespace terrella
