#include "streaming/warp/filter/resample_lines.h"

#include <algorithm>
#include <cstring>

#include "streaming/warp/filter/lanes.h"
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
  const auto row = [&](std::size_t k) { return canvas.at(0, taps.first + static_cast<std::int64_t>(k)); };
  std::ranges::fill(sums, 0.0F);
  std::size_t k = 0;
  // Two rows at once, since reading and writing the sums costs more than adding to them.
  for (; k + 2 <= taps.weights.size(); k += 2) {
    const float weight = taps.weights[k], next_weight = taps.weights[k + 1];
    const float *from = row(k), *next = row(k + 1);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += weight * from[i] + next_weight * next[i];
  }
  if (k == taps.weights.size()) return;
  const float weight = taps.weights[k];
  const float* from = row(k);
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += weight * from[i];
}

/// `kTaps` is the number of taps, if the compiler is to know it; otherwise 0.
template <std::size_t kChannels, std::size_t kTaps>
void sum_column(const std::vector<float>& sums, const Taps& taps, float* out) {
  const std::size_t count = kTaps > 0 ? kTaps : taps.weights.size();
  // Taps of a column beside the raster are none, and begin anywhere.
  const float* from = sums.data() + (count > 0 ? static_cast<std::size_t>(taps.first) * kChannels : 0);
  typename Lanes<kChannels>::Vector sum{};
  for (std::size_t k = 0; k < count; ++k) sum += taps.weights[k] * load<kChannels>(from + k * kChannels);
  std::memcpy(out, &sum, sizeof(sum));
}

/// Sums the columns of a row of the tile.
template <std::size_t kChannels>
void sum_columns(const std::vector<float>& sums, const std::vector<LineTaps>& columns, std::vector<float>& tile_row) {
  float* out = tile_row.data();
  for (const LineTaps& column : columns) {
    column.taps.weights.size() == 4 ? sum_column<kChannels, 4>(sums, column.taps, out)
                                    : sum_column<kChannels, 0>(sums, column.taps, out);
    out += kChannels;
  }
}

/// The same sum without negative weights.
template <std::size_t kChannels>
void sum_positive(const Canvas<kChannels>& canvas, const Taps& column, const Taps& row, float* sum) {
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
  for (std::size_t c = 0; c < kChannels; ++c) sum[c] /= all;
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
void resample_lines(const std::vector<LineTaps>& columns, std::span<const LineTaps> rows,
                    const Canvas<Tile::kChannels>& canvas, typename Tile::Pixels& to) {
  std::vector<float> sums(static_cast<std::size_t>(canvas.rect.width()) * Tile::kChannels);
  std::vector<float> tile_row(columns.size() * Tile::kChannels);
  const bool inside = std::ranges::all_of(columns, [](const LineTaps& column) { return column.coverage >= 1.0F; });
  for (std::size_t y = 0; y < rows.size(); ++y) {
    const LineTaps& row = rows[y];
    if (row.coverage <= 0.0F || row.taps.weights.empty()) continue;
    sum_rows(canvas, row.taps, sums);
    sum_columns<Tile::kChannels>(sums, columns, tile_row);
    const std::size_t line = y * columns.size();
    for (std::size_t x = 0; x < columns.size(); ++x) {
      const LineTaps& column = columns[x];
      float* sum = tile_row.data() + x * Tile::kChannels;
      if (column.taps.weights.empty()) continue;
      if (!Tile::is_whole(sum)) sum_positive(canvas, column.taps, row.taps, sum);
      if (!inside || row.coverage < 1.0F) Tile::write(sum, row.coverage * column.coverage, to, line + x);
    }
    if (inside && row.coverage >= 1.0F) Tile::write_row(tile_row.data(), columns.size(), to, line);
  }
}

template std::optional<TileFailure> copy_lines<ColourTile>(const WarpPlan&, const WarpLevel&, const BlockAt&, Image&);
template std::optional<TileFailure> copy_lines<NumberTile>(const WarpPlan&, const WarpLevel&, const BlockAt&, Numbers&);
template void resample_lines<ColourTile>(const std::vector<LineTaps>&, std::span<const LineTaps>, const ColourCanvas&,
                                         Image&);
template void resample_lines<NumberTile>(const std::vector<LineTaps>&, std::span<const LineTaps>, const NumberCanvas&,
                                         Numbers&);

}  // namespace terrella
