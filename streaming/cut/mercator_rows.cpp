#include "streaming/cut/mercator_rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "streaming/cut/halve.h"
#include "streaming/cut/mercator_plan.h"
#include "streaming/raster/in_parallel.h"
#include "streaming/warp/filter/resample_lines.h"
#include "streaming/warp/tile_pixels.h"

namespace terrella {
namespace {

/// Most memory of the rows that are made at a time, bytes, and most of these rows.
constexpr std::int64_t kMadeBytes = 8LL << 20;
constexpr std::int64_t kMostMade = 64;
/// Rows of the picture that stay for the next rows, above those in use: taps leave out rows of no weight, which the
/// next row may need.
constexpr std::int64_t kStaying = 4;

/// Brings a row of the picture onto a canvas.
void put_on_canvas(std::span<const std::uint8_t> row, ColourCanvas&, float* to) { premultiply(row, to); }
void put_on_canvas(std::span<const std::uint8_t> row, NumberCanvas&, float* to) {
  for (std::size_t i = 0; i < row.size(); i += 4, to += 2) {
    float number = 0.0F;
    std::memcpy(&number, row.data() + i, sizeof(number));
    const bool known = std::isfinite(number);
    to[0] = known ? number : 0.0F;
    to[1] = known ? 1.0F : 0.0F;
  }
}

void clear(Image& made, std::size_t pixels) { made.rgba.assign(pixels * 4, 0); }
void clear(Numbers& made, std::size_t pixels) { made.values.assign(pixels, std::numeric_limits<float>::quiet_NaN()); }
const void* pixel_at(const Image& made, std::size_t at) { return made.rgba.data() + at * 4; }
const void* pixel_at(const Numbers& made, std::size_t at) { return made.values.data() + at; }

/// A number has no part: the plan has left out the lines that are not covered enough.
void cover_whole(const NumberCanvas&, LineTaps& line) {
  if (!line.taps.weights.empty()) line.coverage = 1.0F;
}
void cover_whole(const ColourCanvas&, LineTaps&) {}

std::vector<LineTaps> column_taps(const CutPlan& picture, const CutPlan& plan, double width_px) {
  const auto at = [&](double column) { return picture_column(picture, mercator_lon_deg(plan, column)); };
  std::vector<LineTaps> taps;
  taps.reserve(static_cast<std::size_t>(plan.finest.x1 - plan.finest.x0));
  for (std::int64_t x = plan.finest.x0; x < plan.finest.x1; ++x) {
    const auto first = static_cast<double>(x);
    taps.push_back(line_taps({at(first), at(first + 0.5), at(first + 1.0)}, picture.wraps ? 0.0 : width_px));
  }
  return taps;
}

template <class Tile>
class MercatorRows : public RowReader {
 public:
  MercatorRows(std::unique_ptr<RowReader> rows, const CutPlan& picture, const CutPlan& plan, const Ellipsoid& figure,
               int jobs)
      : rows_(std::move(rows)),
        picture_(picture),
        plan_(plan),
        figure_(figure),
        jobs_(thread_count(jobs)),
        info_(rows_->info()),
        width_px_(info_.width_px),
        height_px_(info_.height_px),
        columns_(column_taps(picture, plan, static_cast<double>(width_px_))) {
    const PixelRect& px = plan.finest;
    info_ = {.width_px = px.x1 - px.x0,
             .height_px = px.y1 - px.y0,
             .has_alpha = info_.has_alpha || !is_planet(plan),
             .opaque_inside = !info_.has_alpha || info_.opaque_inside,
             .orientation = info_.orientation};
    for (const LineTaps& column : columns_) {
      canvas_.rect.u0 = std::min(canvas_.rect.u0, column.taps.first);
      canvas_.rect.u1 = std::max(canvas_.rect.u1, column.taps.first + std::ssize(column.taps.weights));
    }
    canvas_.rect.u1 = std::max(canvas_.rect.u1, width_px_);
    for (LineTaps& column : columns_) {
      column.taps.first -= canvas_.rect.u0;
      cover_whole(canvas_, column);
    }
    read_.resize(static_cast<std::size_t>(width_px_) * 4);
    made_rows_ = std::clamp<std::int64_t>(kMadeBytes / (4 * info_.width_px), 1, kMostMade);
  }

  [[nodiscard]] const PictureInfo& info() const override { return info_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    if (row_ >= made_end_) {
      if (Status made = make_rows(); !made) return made;
    }
    const std::int64_t in_made = row_ - made_begin_;
    const auto& part = made_[static_cast<std::size_t>(in_made / part_rows_)];
    std::memcpy(rgba.data(), pixel_at(part, static_cast<std::size_t>(in_made % part_rows_ * info_.width_px)),
                rgba.size());
    ++row_;
    return Done{};
  }

  [[nodiscard]] Status skip_rows(std::int64_t rows) override {
    row_ += rows;
    return Done{};
  }

 private:
  static constexpr std::size_t kChannels = Tile::kChannels;

  [[nodiscard]] LineTaps row_taps(std::int64_t row) const {
    const auto at = [&](double y) { return picture_row(picture_, figure_, mercator_latitude(plan_, y)); };
    const auto first = static_cast<double>(plan_.finest.y0 + row);
    LineTaps taps = line_taps({at(first), at(first + 0.5), at(first + 1.0)}, static_cast<double>(height_px_));
    cover_whole(canvas_, taps);
    return taps;
  }

  /// Makes the next rows, each job some of them.
  Status make_rows() {
    const std::int64_t count = std::min(made_rows_, info_.height_px - row_);
    std::vector<LineTaps> taps;
    taps.reserve(static_cast<std::size_t>(count));
    std::int64_t first = std::numeric_limits<std::int64_t>::max(), end = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      taps.push_back(row_taps(row_ + i));
      const Taps& made = taps.back().taps;
      if (made.weights.empty()) continue;
      first = std::min(first, made.first);
      end = std::max(end, made.first + std::ssize(made.weights));
    }
    if (first < end) {
      if (Status moved = move_canvas(first - kStaying, end); !moved) return moved;
    }
    for (LineTaps& row : taps) row.taps.first -= canvas_.rect.v0;
    part_rows_ = (count + jobs_ - 1) / jobs_;
    const std::int64_t parts = (count + part_rows_ - 1) / part_rows_;
    made_.resize(static_cast<std::size_t>(parts));
    in_parallel(jobs_, parts, [&](std::int64_t part) {
      const std::int64_t begin = part * part_rows_;
      const auto rows = static_cast<std::size_t>(std::min(part_rows_, count - begin));
      auto& to = made_[static_cast<std::size_t>(part)];
      clear(to, rows * columns_.size());
      resample_lines<Tile>(columns_, std::span(taps).subspan(static_cast<std::size_t>(begin), rows), canvas_, to);
    });
    made_begin_ = row_;
    made_end_ = row_ + count;
    return Done{};
  }

  /// Moves the canvas to the picture's rows [first, end). Rows beyond the picture repeat its edge.
  Status move_canvas(std::int64_t first, std::int64_t end) {
    const std::int64_t row_floats = canvas_.rect.width() * std::int64_t{kChannels};
    if (!canvas_.sums.empty()) {
      first = std::max(first, canvas_.rect.v0);
      const std::int64_t dropped = std::min(first, canvas_.rect.v1) - canvas_.rect.v0;
      canvas_.sums.erase(canvas_.sums.begin(), canvas_.sums.begin() + dropped * row_floats);
    }
    const std::int64_t held = std::ssize(canvas_.sums) / row_floats;
    canvas_.rect.v0 = first;
    canvas_.rect.v1 = std::max(end, first + held);
    canvas_.sums.resize(static_cast<std::size_t>(row_floats * canvas_.rect.height()));
    for (std::int64_t row = held; row < canvas_.rect.height(); ++row) {
      const std::int64_t wanted = std::clamp<std::int64_t>(first + row, 0, height_px_ - 1);
      if (wanted >= next_) {
        if (Status skipped = rows_->skip_rows(wanted - next_); !skipped) return skipped;
        if (Status read = rows_->read_row(read_); !read) return read;
        next_ = wanted + 1;
      }
      put_row(canvas_.at(0, row));
    }
    return Done{};
  }

  /// Writes the row that was read last, and goes on beyond its ends: round the planet, or with the edge's pixel.
  void put_row(float* to) {
    const std::int64_t before = -canvas_.rect.u0;
    put_on_canvas(read_, canvas_, to + before * std::int64_t{kChannels});
    const auto copy = [&](std::int64_t from, std::int64_t column) {
      std::copy_n(to + (from + before) * std::int64_t{kChannels}, kChannels,
                  to + (column + before) * std::int64_t{kChannels});
    };
    for (std::int64_t u = canvas_.rect.u0; u < 0; ++u) {
      copy(picture_.wraps ? (u % width_px_ + width_px_) % width_px_ : 0, u);
    }
    for (std::int64_t u = width_px_; u < canvas_.rect.u1; ++u) copy(picture_.wraps ? u % width_px_ : width_px_ - 1, u);
  }

  const std::unique_ptr<RowReader> rows_;
  const CutPlan picture_;
  const CutPlan plan_;
  const Ellipsoid figure_;
  const int jobs_;
  PictureInfo info_;
  const std::int64_t width_px_, height_px_;  ///< the size of the picture
  std::vector<LineTaps> columns_;
  Canvas<kChannels> canvas_{};
  std::vector<std::uint8_t> read_;  ///< the picture's row before next_
  std::int64_t next_ = 0;
  std::int64_t row_ = 0;
  std::int64_t made_rows_ = 1, part_rows_ = 1;
  std::int64_t made_begin_ = 0, made_end_ = 0;
  std::vector<typename Tile::Pixels> made_;  ///< part_rows_ rows each
};

}  // namespace

std::unique_ptr<RowReader> mercator_rows(std::unique_ptr<RowReader> rows, const CutPlan& picture, const CutPlan& plan,
                                         const Ellipsoid& figure, bool numbers, int jobs) {
  if (numbers) return std::make_unique<MercatorRows<NumberTile>>(std::move(rows), picture, plan, figure, jobs);
  return std::make_unique<MercatorRows<ColourTile>>(std::move(rows), picture, plan, figure, jobs);
}

}  // namespace terrella
