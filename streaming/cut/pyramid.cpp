#include "streaming/cut/pyramid.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "streaming/cut/halve.h"
#include "streaming/cut/input/heights.h"

namespace terrella {
namespace {

std::int64_t ceil_divide(std::int64_t a, std::int64_t b) { return (a + b - 1) / b; }

Strip strip_shape(const CutPlan& plan, int level) {
  const PixelRect px = pixels_at(plan, level);
  const int tile_px = plan.grid.tile_px;
  return {.level = level,
          .tile_y = 0,
          .tile_x0 = px.x0 / tile_px,
          .tiles = ceil_divide(px.x1, tile_px) - px.x0 / tile_px,
          .tile_px = tile_px,
          .turn_px = plan.wraps ? px.x1 : 0};
}

std::size_t shape_bytes(const Strip& shape) { return shape.stride_bytes() * static_cast<std::size_t>(shape.tile_px); }

}  // namespace

Pyramid::Pyramid(const CutPlan& plan, const PyramidPart& part, StripPool& pool, TakeStrip take_strip, TakeRow take_row)
    : plan_(plan), part_(part), pool_(pool), take_strip_(std::move(take_strip)), take_row_(std::move(take_row)) {
  const auto begin = [&](int level, bool rows) {
    Level made = make_level(plan, level);
    made.y = std::max(made.px.y0, part.first_row >> (part.finest - level));
    for (auto& row : made.rows) row.resize(rows ? made.width() * 4 : 0);
    return made;
  };
  for (int level = part.coarsest; level <= part.finest; ++level) {
    levels_.push_back(begin(level, level != plan.grid.max_level || part.pixels != PixelKind::opaque));
  }
  if (part.coarsest > 0) above_coarsest_ = begin(part.coarsest - 1, true);
}

std::size_t Pyramid::finest_strip_bytes(const CutPlan& plan) {
  return shape_bytes(strip_shape(plan, plan.grid.max_level));
}

std::size_t Pyramid::row_floats(const CutPlan& plan, int level) {
  const PixelRect px = pixels_at(plan, level);
  return static_cast<std::size_t>(px.x1 - px.x0) * 4;
}

std::size_t Pyramid::strip_bytes(const CutPlan& plan, const PyramidPart& part) {
  std::size_t bytes = 0;
  for (int level = part.coarsest; level <= part.finest; ++level) bytes += shape_bytes(strip_shape(plan, level));
  return bytes;
}

Pyramid::Level& Pyramid::above(const Level& level) {
  return level.level == part_.coarsest ? above_coarsest_
                                       : levels_[static_cast<std::size_t>(level.level - 1 - part_.coarsest)];
}

Pyramid::Level Pyramid::make_level(const CutPlan& plan, int level) {
  Level made;
  made.level = level;
  made.px = pixels_at(plan, level);
  made.shape = strip_shape(plan, level);
  made.lead_px = made.px.x0 - made.shape.tile_x0 * plan.grid.tile_px;
  made.y = made.px.y0;
  if (plan.wraps) {
    // One column more than the tiles show: the partner of an odd last column.
    const std::int64_t end = made.shape.tiles * plan.grid.tile_px;
    for (std::int64_t x = made.px.x1; x <= end; ++x) made.beyond.push_back(wrapped(plan, level, x));
  } else {
    made.first_cover = cover(plan, level, made.px.x0);
    made.last_cover = cover(plan, level, made.px.x1 - 1);
  }
  return made;
}

float Pyramid::cover(const CutPlan& plan, int level, std::int64_t x) {
  const int shift = plan.grid.max_level - level;
  const std::int64_t from = std::max(x << shift, plan.finest.x0);
  const std::int64_t to = std::min((x + 1) << shift, plan.finest.x1);
  return static_cast<float>(static_cast<double>(to - from) / static_cast<double>(std::int64_t{1} << shift));
}

Pyramid::WrappedColumn Pyramid::wrapped(const CutPlan& plan, int level, std::int64_t x) {
  const int shift = plan.grid.max_level - level;
  const std::int64_t turn = plan.finest.x1;
  const std::int64_t finest = (x << shift) % turn;
  const std::int64_t column = finest >> shift;
  const std::int64_t rest = finest - (column << shift);
  return {column, static_cast<float>(static_cast<double>(rest) / static_cast<double>(std::int64_t{1} << shift))};
}

std::uint8_t* Pyramid::strip_row(Level& level) {
  const std::int64_t tile_y = level.y / plan_.grid.tile_px;
  if (!level.strip) {
    level.shape.tile_y = tile_y;
    level.shape.squeeze = squeeze_of_row(plan_.grid, level.level, tile_y);
    level.strip = pool_.lend(level.shape);
  }
  return level.strip->row(level.y - tile_y * plan_.grid.tile_px);
}

std::span<std::uint8_t> Pyramid::next_row() {
  Level& finest = levels_.back();
  return {strip_row(finest) + finest.lead_px * 4, finest.width() * 4};
}

void Pyramid::row_written() {
  Level& finest = levels_.back();
  finest.areas[finest.y & 1] = finest_row_area(plan_, finest.y);
  std::uint8_t* row = strip_row(finest) + finest.lead_px * 4;
  if (part_.pixels == PixelKind::opaque) {
    // Tiles have an even number of rows, so both rows of a pair are in the same strip.
    const std::uint8_t* even = (finest.y & 1) == 0 ? row : row - finest.shape.stride_bytes();
    halve_if_due(finest, even, row);
  } else {
    std::vector<float>& floats = finest.rows[finest.y & 1];
    const std::span<const std::uint8_t> pixels(row, floats.size());
    part_.pixels == PixelKind::alpha ? premultiply(pixels, floats.data()) : heights_to_floats(pixels, floats.data());
    if (part_.pixels == PixelKind::height) floats_to_heights(floats, part_.nodata, row);
    halve_if_due(finest, finest.rows[0].data(), finest.rows[1].data());
  }
  close_strip_row(finest);
}

void Pyramid::put_row(double area, std::span<const float> row) {
  Level& finest = levels_.back();
  finest.areas[finest.y & 1] = area;
  std::ranges::copy(row, finest.rows[finest.y & 1].begin());
  coarse_row_done(finest);
}

void Pyramid::to_pixels(std::span<const float> row, std::uint8_t* out) const {
  switch (part_.pixels) {
    case PixelKind::opaque:
      return to_bytes(row, out);
    case PixelKind::alpha:
      return unpremultiply(row, out);
    case PixelKind::height:
      return floats_to_heights(row, part_.nodata, out);
    case PixelKind::number:
      return floats_to_numbers(row, out);
  }
}

void Pyramid::coarse_row_done(Level& level) {
  if (level.level < part_.coarsest) {
    take_row_(level.areas[level.y & 1], level.rows[level.y & 1]);
    ++level.y;
    return;
  }
  to_pixels(level.rows[level.y & 1], strip_row(level) + level.lead_px * 4);
  halve_if_due(level, level.rows[0].data(), level.rows[1].data());
  close_strip_row(level);
}

/// Halves a complete pair of rows. A pair is complete with its odd row, or with the last row of all. A row without a
/// partner is its own partner.
template <class T>
void Pyramid::halve_if_due(Level& from, const T* even, const T* odd) {
  if (from.level == 0) return;
  const bool is_odd = (from.y & 1) != 0;
  if (!is_odd && from.y + 1 < from.px.y1) return;
  if (!is_odd) {
    odd = even;
    from.areas[1] = 0.0;
  } else if (from.y == from.px.y0) {
    even = odd;
    from.areas[0] = 0.0;
  }
  Level& to = above(from);
  halve_into(from, even, odd, to);
  coarse_row_done(to);
}

template <class T>
void Pyramid::halve_into(const Level& from, const T* even, const T* odd, Level& to) {
  const double area = from.areas[0] + from.areas[1];
  const auto weight = [&](std::size_t row) { return static_cast<float>(from.areas[row] / area); };
  const std::array<float, 2> weights = {weight(0), weight(1)};
  to.areas[to.y & 1] = area;
  float* out = to.rows[to.y & 1].data();
  const std::int64_t first = from.px.x0 & 1;  // columns before the first pair
  const std::int64_t pairs = (from.px.x1 - from.px.x0 - first) / 2;
  halve_rows(even + first * 4, odd + first * 4, weights[0], weights[1], out + first * 4,
             static_cast<std::size_t>(pairs));
  mix_edge(from, even, odd, weights, to.px.x0, to);
  mix_edge(from, even, odd, weights, to.px.x1 - 1, to);
}

/// Computes a coarse column whose two finer columns may be partly covered, missing, or beyond ±180°.
template <class T>
void Pyramid::mix_edge(const Level& from, const T* even, const T* odd, const std::array<float, 2>& weights,
                       std::int64_t column, Level& to) {
  std::array<float, 4> sum{};
  float covered = 0.0F;
  const auto add = [&](std::int64_t x, float share) {
    const auto at = static_cast<std::size_t>(x - from.px.x0) * 4;
    for (std::size_t c = 0; c < 4; ++c) {
      sum[c] += share * (weights[0] * static_cast<float>(even[at + c]) + weights[1] * static_cast<float>(odd[at + c]));
    }
    covered += share;
  };
  for (std::int64_t x = 2 * column; x < 2 * column + 2; ++x) {
    if (x == from.px.x1 && plan_.wraps) {
      const WrappedColumn& beyond = from.beyond.front();
      add(beyond.column, 1.0F - beyond.share);
      add((beyond.column + 1) % from.px.x1, beyond.share);
    } else if (x >= from.px.x0 && x < from.px.x1) {
      add(x, x == from.px.x0 ? from.first_cover : x == from.px.x1 - 1 ? from.last_cover : 1.0F);
    }
  }
  float* out = to.rows[to.y & 1].data() + static_cast<std::size_t>(column - to.px.x0) * 4;
  for (std::size_t c = 0; c < 4; ++c) out[c] = sum[c] / covered;
}

/// Makes a pixel transparent or unknown, if the kind of pixels has that.
void Pyramid::clear(std::uint8_t* pixel) const {
  if (part_.pixels == PixelKind::alpha) pixel[3] = 0;
  if (part_.pixels == PixelKind::height) clear_height(part_.nodata, pixel);
  if (part_.pixels == PixelKind::number) put_number(std::numeric_limits<float>::quiet_NaN(), pixel);
}

/// Pixels beside a region repeat its edge; where pictures have transparency or unknown pixels, they are that.
void Pyramid::put_beside(const std::uint8_t* edge, std::uint8_t* to) const {
  std::memcpy(to, edge, 4);
  clear(to);
}

/// Rows beyond a pole repeat the last row, because filters reach there.
void Pyramid::fill_row(Level& level, std::int64_t in_strip, const std::uint8_t* edge, bool beyond_pole) const {
  std::uint8_t* row = level.strip->row(in_strip);
  const std::size_t stride = level.shape.stride_bytes();
  std::memcpy(row, edge, stride);
  if (part_.pixels == PixelKind::opaque || beyond_pole) return;
  for (std::size_t i = 0; i < stride; i += 4) clear(row + i);
}

void Pyramid::pad_row(const Level& level, std::uint8_t* row) const {
  const std::uint8_t* first = row + level.lead_px * 4;
  // A picture that crosses ±180° continues in the piece on the other side.
  const bool goes_on = plan_.turn_px > 0 && plan_.finest.x1 == plan_.turn_px;
  for (std::int64_t x = 0; x < level.lead_px; ++x) put_beside(first, row + x * 4);
  const auto width = static_cast<std::int64_t>(level.width());
  const std::int64_t end = level.shape.tiles * level.shape.tile_px;
  for (std::int64_t x = level.lead_px + width; x < end; ++x) {
    if (!plan_.wraps) {
      const std::uint8_t* last = first + (width - 1) * 4;
      goes_on ? static_cast<void>(std::memcpy(row + x * 4, last, 4)) : put_beside(last, row + x * 4);
      continue;
    }
    const WrappedColumn& beyond = level.beyond[static_cast<std::size_t>(x - width)];
    const std::uint8_t* a = row + beyond.column * 4;
    const std::uint8_t* b = row + (beyond.column + 1) % width * 4;
    if (part_.pixels == PixelKind::height) {
      mix_heights(a, b, beyond.share, part_.nodata, row + x * 4);
      continue;
    }
    if (part_.pixels == PixelKind::number) {
      mix_numbers(a, b, beyond.share, row + x * 4);
      continue;
    }
    for (int c = 0; c < 4; ++c) {
      const float mixed = (1.0F - beyond.share) * static_cast<float>(a[c]) + beyond.share * static_cast<float>(b[c]);
      row[x * 4 + c] = static_cast<std::uint8_t>(static_cast<int>(mixed + 0.5F));
    }
  }
}

/// Ends a row of a strip. After its last row, rows outside the picture are filled and the strip is emitted.
void Pyramid::close_strip_row(Level& level) {
  const std::int64_t in_strip = level.y % plan_.grid.tile_px;
  std::uint8_t* row = level.strip->row(in_strip);
  pad_row(level, row);
  if (level.y == level.px.y0) {
    const bool beyond_pole = plan_.grid.bounds.north.deg() >= 90.0;
    for (std::int64_t y = 0; y < in_strip; ++y) fill_row(level, y, row, beyond_pole);
  }
  ++level.y;
  const bool last = level.y == level.px.y1;
  if (!last && level.y % plan_.grid.tile_px != 0) return;
  const bool beyond_pole = plan_.grid.bounds.south.deg() <= -90.0;
  for (std::int64_t y = in_strip + 1; y < plan_.grid.tile_px; ++y) fill_row(level, y, row, beyond_pole);
  take_strip_(std::move(level.strip));
  level.strip.reset();
}

}  // namespace terrella
