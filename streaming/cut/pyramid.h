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

/// Meaning of the four bytes of a pixel in a strip.
enum class PixelKind {
  opaque,  ///< RGBA8, every alpha 255
  alpha,   ///< RGBA8, not premultiplied
  /// Pixels as read: a 32-bit float, NaN for no height. Pixels of a finished row: 16 bits
  /// (streaming/cut/input/heights.h).
  height,
  number,  ///< a 32-bit float, NaN for no data, as read and in finished rows
};

/// Levels and rows that one Pyramid makes.
struct PyramidPart {
  int coarsest = 0;
  int finest = 0;
  /// First row at the finest of these levels: a multiple of tile_px · 2^(finest - coarsest), or a row above the
  /// picture.
  std::int64_t first_row = 0;
  PixelKind pixels = PixelKind::opaque;
  std::optional<std::uint16_t> nodata = {};  ///< for heights only
};

/// Builds the levels of a pyramid part. Takes rows from the top. Emits each strip as soon as its last row is known, and
/// the rows of the next coarser level. Another Pyramid continues from those rows to the same bytes. Holds one strip and
/// two rows of each level.
///
/// A coarse pixel is the mean of 2×2 finer pixels, weighted by their area on the sphere (streaming/cut/README.md). If
/// the width of a level is odd, the partner of the last column lies beyond +180°. The partner is the first column, or
/// lies between the first two columns if an earlier odd width shifted them. The longitude of x is that of x · 2^s
/// modulo the picture's width. Pixels of a strip outside the picture repeat the nearest row and column, or wrap round
/// the planet. thread: one at a time
class Pyramid {
 public:
  using TakeStrip = std::function<void(std::shared_ptr<const Strip>)>;
  /// Receives a row of the level above the coarsest, as premultiplied floats, with its area.
  using TakeRow = std::function<void(double area, std::span<const float> row)>;
  Pyramid(const CutPlan& plan, const PyramidPart& part, StripPool& pool, TakeStrip take_strip, TakeRow take_row);

  /// Most memory of all strips in progress, and memory of one finest strip.
  [[nodiscard]] static std::size_t strip_bytes(const CutPlan& plan, const PyramidPart& part);
  [[nodiscard]] static std::size_t finest_strip_bytes(const CutPlan& plan);
  /// Floats in a row that another part hands over for this level.
  [[nodiscard]] static std::size_t row_floats(const CutPlan& plan, int level);

  /// Buffer for the next row of the picture, 4 · width bytes; call row_written() after filling it. For a part with the
  /// picture's finest level.
  [[nodiscard]] std::span<std::uint8_t> next_row();
  void row_written();
  /// Adds the next row of the finest of these levels, from the part below.
  void put_row(double area, std::span<const float> row);

 private:
  /// Source of a column beyond the last: (1 - share) of `column` plus `share` of the next column.
  struct WrappedColumn {
    std::int64_t column;
    float share;
  };
  struct Level {
    int level = 0;
    PixelRect px{};
    Strip shape;               ///< without pixels and row
    std::int64_t lead_px = 0;  ///< pixels from the left edge of the strip to the left edge of the picture
    float first_cover = 1.0F;  ///< fraction of the first and last column that the picture covers
    float last_cover = 1.0F;
    std::vector<WrappedColumn> beyond;  ///< columns from px.x1 on
    std::int64_t y = 0;                 ///< next row
    std::shared_ptr<Strip> strip;
    std::array<std::vector<float>, 2> rows;  ///< last even and last odd row, premultiplied
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
  void put_beside(const std::uint8_t* edge, std::uint8_t* to) const;
  void clear(std::uint8_t* pixel) const;
  void fill_row(Level& level, std::int64_t in_strip, const std::uint8_t* edge, bool beyond_pole) const;
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
  std::vector<Level> levels_;  ///< coarsest first
  Level above_coarsest_;       ///< holds rows only
};

}  // namespace terrella
