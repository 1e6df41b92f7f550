#include "streaming/cut/growing/coarse_canvas.h"

#include <algorithm>
#include <cmath>
#include <mutex>

namespace terrella {
namespace {

constexpr std::int64_t kWidestCanvas_px = 2048;
/// Rows of the picture that are summed for a row of the canvas.
constexpr std::int64_t kSummedRows = 4;

int canvas_level(const CutPlan& plan) {
  int level = plan.grid.max_level;
  for (; level > plan.grid.min_level; --level) {
    const PixelRect px = pixels_at(plan, level);
    if (std::max(px.x1 - px.x0, px.y1 - px.y0) <= kWidestCanvas_px) break;
  }
  return level;
}

}  // namespace

CoarseCanvas::CoarseCanvas(const CutPlan& plan) : plan_(plan), grid_(plan.grid) {
  grid_.reduced = false;
  grid_.max_level = canvas_level(plan);
  halvings_ = plan.grid.max_level - grid_.max_level;
  px_ = pixels_at(plan, grid_.max_level);
  const std::int64_t turn = plan.wraps ? plan.finest.x1 : plan.turn_px;
  turn_px_ = (turn + (std::int64_t{1} << halvings_) - 1) >> halvings_;
  pixels_.resize(static_cast<std::size_t>((px_.x1 - px_.x0) * (px_.y1 - px_.y0)) * 4);
  sums_.resize(static_cast<std::size_t>(px_.x1 - px_.x0) * 4);
  counts_.resize(static_cast<std::size_t>(px_.x1 - px_.x0));
}

std::vector<TileId> CoarseCanvas::tiles() const {
  std::vector<TileId> ids;
  const std::int64_t side = grid_.tile_px, across = columns(grid_, grid_.max_level);
  for (std::int64_t y = px_.y0 / side; y * side < px_.y1; ++y) {
    for (std::int64_t x = px_.x0 / side; x * side < px_.x1; ++x) {
      const TileId id{.level = grid_.max_level, .x = x % across, .y = y};
      if (std::ranges::find(ids, id) == ids.end()) ids.push_back(id);
    }
  }
  return ids;
}

void CoarseCanvas::paint(const TileId& id, const Image& tile) {
  const std::int64_t side = grid_.tile_px, width = px_.x1 - px_.x0;
  const std::lock_guard lock(mutex_);
  // A picture that crosses ±180° goes on in the columns beyond.
  for (const std::int64_t turn : {std::int64_t{0}, turn_px_}) {
    const std::int64_t left = id.x * side + turn;
    const std::int64_t from = std::max(left, px_.x0), to = std::min(left + side, px_.x1);
    for (std::int64_t y = std::max(id.y * side, px_.y0); from < to && y < std::min((id.y + 1) * side, px_.y1); ++y) {
      const auto* pixel = tile.rgba.data() + static_cast<std::size_t>((y - id.y * side) * side + from - left) * 4;
      std::copy_n(pixel, (to - from) * 4, pixels_.begin() + ((y - px_.y0) * width + from - px_.x0) * 4);
    }
    if (turn_px_ == 0) break;
  }
}

std::int64_t CoarseCanvas::row_step() const {
  return std::max<std::int64_t>(1, (std::int64_t{1} << halvings_) / kSummedRows);
}

void CoarseCanvas::add_row(std::int64_t row, std::span<const std::uint8_t> rgba) {
  const std::int64_t to = ((plan_.finest.y0 + row) >> halvings_) - px_.y0;
  if (to != summing_) {
    std::ranges::fill(sums_, 0.0F);
    std::ranges::fill(counts_, 0.0F);
    summing_ = to;
  }
  // Four pixels of each square are enough.
  const std::int64_t step = row_step();
  for (std::int64_t x = 0; x < plan_.finest.x1 - plan_.finest.x0; x += step) {
    const std::uint8_t* from = rgba.data() + x * 4;
    const std::int64_t column = ((plan_.finest.x0 + x) >> halvings_) - px_.x0;
    float* sum = sums_.data() + column * 4;
    counts_[static_cast<std::size_t>(column)] += 1.0F;
    for (int c = 0; c < 3; ++c) sum[c] += static_cast<float>(from[c]) * static_cast<float>(from[3]);
    sum[3] += static_cast<float>(from[3]);
  }
  put_row(to);
}

/// Writes the mean of the rows summed so far.
void CoarseCanvas::put_row(std::int64_t row) {
  const std::lock_guard lock(mutex_);
  std::uint8_t* to = pixels_.data() + row * (px_.x1 - px_.x0) * 4;
  for (std::size_t i = 0; i < sums_.size(); i += 4, to += 4) {
    const float alpha = sums_[i + 3];
    for (std::size_t c = 0; c < 3; ++c)
      to[c] = static_cast<std::uint8_t>(alpha > 0.0F ? sums_[i + c] / alpha + 0.5F : 0);
    to[3] = static_cast<std::uint8_t>(alpha / std::max(counts_[i / 4], 1.0F) + 0.5F);
  }
}

/// The interval is at least a pixel long, so that magnified tiles are interpolated.
CoarseCanvas::Taps CoarseCanvas::taps(double from, double to, std::int64_t first, std::int64_t size, std::int64_t turn,
                                      bool clamped) const {
  const double middle = 0.5 * (from + to), length = std::max(to - from, 1.0);
  from = middle - 0.5 * length;
  to = middle + 0.5 * length;
  Taps found;
  for (auto at = static_cast<std::int64_t>(std::floor(from)); static_cast<double>(at) < to; ++at) {
    const double part = std::min(to, static_cast<double>(at + 1)) - std::max(from, static_cast<double>(at));
    std::int64_t pixel = at - first;
    if (turn > 0) pixel = ((pixel % turn) + turn) % turn;
    if (clamped) pixel = std::clamp<std::int64_t>(pixel, 0, size - 1);
    if (pixel >= 0 && pixel < size && part > 0.0) found.pixels.emplace_back(pixel, static_cast<float>(part / length));
  }
  return found;
}

Image CoarseCanvas::tile(const TileId& id) const {
  const int side = grid_.tile_px;
  const std::int64_t width = px_.x1 - px_.x0, height = px_.y1 - px_.y0;
  const double pixel = std::ldexp(1.0, grid_.max_level - id.level), wide = std::ldexp(pixel, id.squeeze);
  std::vector<Taps> columns, rows;
  for (int i = 0; i < side; ++i) {
    const auto x = static_cast<double>(id.x * side + i), y = static_cast<double>(id.y * side + i);
    columns.push_back(taps(x * wide, (x + 1.0) * wide, px_.x0, width, turn_px_, plan_.wraps));
    rows.push_back(taps(y * pixel, (y + 1.0) * pixel, px_.y0, height, 0, plan_.wraps));
  }
  Image made{.width_px = side,
             .height_px = side,
             .rgba = std::vector<std::uint8_t>(static_cast<std::size_t>(side) * side * 4)};
  std::uint8_t* to = made.rgba.data();
  const std::shared_lock lock(mutex_);
  for (const Taps& row : rows) {
    for (const Taps& column : columns) {
      float sum[4] = {};
      for (const auto& [y, share_y] : row.pixels) {
        for (const auto& [x, share_x] : column.pixels) {
          const std::uint8_t* from = pixels_.data() + (y * width + x) * 4;
          const float alpha = share_y * share_x * static_cast<float>(from[3]);
          for (int c = 0; c < 3; ++c) sum[c] += alpha * static_cast<float>(from[c]);
          sum[3] += alpha;
        }
      }
      for (int c = 0; c < 3; ++c) to[c] = static_cast<std::uint8_t>(sum[3] > 0.0F ? sum[c] / sum[3] + 0.5F : 0.0F);
      to[3] = static_cast<std::uint8_t>(sum[3] + 0.5F);
      to += 4;
    }
  }
  return made;
}

}  // namespace terrella
