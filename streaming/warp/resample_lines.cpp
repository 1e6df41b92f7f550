#include "streaming/warp/resample_lines.h"

#include <algorithm>

#include "streaming/warp/tile_pixels.h"

namespace terrella {
namespace {

/// The first line of a tile that lies on the source.
std::size_t first_line(const std::vector<LineTaps>& lines) {
  const auto found = std::ranges::find_if(lines, [](const LineTaps& line) { return !line.taps.weights.empty(); });
  return static_cast<std::size_t>(found - lines.begin());
}

bool are_copies(const std::vector<LineTaps>& lines) {
  const std::size_t first = first_line(lines);
  bool ended = false;
  for (std::size_t i = first; i < lines.size(); ++i) {
    const LineTaps& line = lines[i];
    ended = ended || line.taps.weights.empty();
    if (ended && !line.taps.weights.empty()) return false;
    if (ended) continue;
    if (line.taps.weights.size() != 1 || line.coverage < 0.999F) return false;
    if (line.taps.first != lines[first].taps.first + static_cast<std::int64_t>(i - first)) return false;
  }
  return first < lines.size();
}

template <std::size_t kChannels>
void sum_rows(const Canvas<kChannels>& canvas, const Taps& taps, std::vector<float>& sums) {
  std::ranges::fill(sums, 0.0F);
  for (std::size_t k = 0; k < taps.weights.size(); ++k) {
    const float weight = taps.weights[k];
    const float* row = canvas.at(0, taps.first + static_cast<std::int64_t>(k));
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += weight * row[i];
  }
}

template <std::size_t kChannels>
void sum_columns(const std::vector<float>& sums, const Taps& taps, float (&sum)[kChannels]) {
  const float* from = sums.data() + static_cast<std::size_t>(taps.first) * kChannels;
  for (const float weight : taps.weights) {
    for (std::size_t c = 0; c < kChannels; ++c) sum[c] += weight * from[c];
    from += kChannels;
  }
}

/// The same sum without negative weights.
template <std::size_t kChannels>
void sum_positive(const Canvas<kChannels>& canvas, const Taps& column, const Taps& row, float (&sum)[kChannels]) {
  float all = 0.0F;
  std::fill_n(sum, kChannels, 0.0F);
  for (std::size_t j = 0; j < row.weights.size(); ++j) {
    for (std::size_t i = 0; i < column.weights.size(); ++i) {
      const float weight = std::max(row.weights[j], 0.0F) * std::max(column.weights[i], 0.0F);
      const float* from =
          canvas.at(column.first + static_cast<std::int64_t>(i), row.first + static_cast<std::int64_t>(j));
      for (std::size_t c = 0; c < kChannels; ++c) sum[c] += weight * from[c];
      all += weight;
    }
  }
  for (float& part : sum) part /= all;
}

}  // namespace

bool are_copies(const WarpLines& lines) { return are_copies(lines.columns) && are_copies(lines.rows); }

template <class Tile>
std::optional<TileFailure> copy_lines(const WarpPlan& plan, const WarpLevel& level, const BlockAt& block_at,
                                      typename Tile::Pixels& to) {
  const WarpLines& lines = *plan.lines;
  const auto corner = static_cast<std::int64_t>(first_line(lines.rows)) * plan.tile_px +
                      static_cast<std::int64_t>(first_line(lines.columns));
  std::optional<TileFailure> failed;
  for_each_part(level, plan.level, lines.canvas, [&](const BlockPart& part) {
    if (failed) return;
    const auto block = block_at(part.block);
    if (!block) failed = block.error();
    if (!block || !*block) return;
    Tile::copy(std::get<typename Tile::Pixels>(**block), part, to,
               static_cast<std::size_t>(corner + part.to_y * plan.tile_px + part.to_x));
  });
  return failed;
}

template <class Tile>
void resample_lines(const WarpLines& lines, const Canvas<Tile::kChannels>& canvas, typename Tile::Pixels& to) {
  std::vector<float> sums(static_cast<std::size_t>(canvas.rect.width()) * Tile::kChannels);
  for (std::size_t y = 0; y < lines.rows.size(); ++y) {
    const LineTaps& row = lines.rows[y];
    if (row.coverage <= 0.0F || row.taps.weights.empty()) continue;
    sum_rows(canvas, row.taps, sums);
    for (std::size_t x = 0; x < lines.columns.size(); ++x) {
      const LineTaps& column = lines.columns[x];
      if (column.taps.weights.empty()) continue;
      float sum[Tile::kChannels] = {};
      sum_columns(sums, column.taps, sum);
      if (!Tile::is_whole(sum)) sum_positive(canvas, column.taps, row.taps, sum);
      Tile::write(sum, row.coverage * column.coverage, to, y * lines.columns.size() + x);
    }
  }
}

template std::optional<TileFailure> copy_lines<ColourTile>(const WarpPlan&, const WarpLevel&, const BlockAt&, Image&);
template std::optional<TileFailure> copy_lines<NumberTile>(const WarpPlan&, const WarpLevel&, const BlockAt&, Numbers&);
template void resample_lines<ColourTile>(const WarpLines&, const ColourCanvas&, Image&);
template void resample_lines<NumberTile>(const WarpLines&, const NumberCanvas&, Numbers&);

}  // namespace terrella
