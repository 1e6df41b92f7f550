#include "streaming/warp/warp_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "streaming/warp/filter/line_plan.h"

namespace terrella {
namespace {

/// A finer level is not used for a shortfall below this part of its pixels: 2 % of an octave.
constexpr double kLevelSlack = 1.014;
/// The part of a tile that may be shown with less than all detail.
constexpr double kCoarsePart = 0.25;
/// Most source pixels under a tile, in tiles. A raster of very long pixels would need far more.
constexpr double kMostUnder = 16.0;
/// Most source pixels in the canvas of a chunk.
constexpr double kMostCanvas = 512.0 * 1024.0;
/// A filter that starts within this distance of a pixel's edge does not need the pixel.
constexpr double kSliver = 1e-6;

/// Source pixels per pixel of the tile along the meridian, with lengths on the ground equal in all directions: in the
/// direction where they are fewest. `weight` is the patch's area on the ground.
struct PatchScale {
  double fewest;
  double weight;
  double under;  ///< source pixels under the patch
};

PatchScale scale_of(const Patch& patch, const PixelMap& tile) {
  const Jacobian raw = patch.jacobian(0.0, 0.0);
  const auto [j, ground] = tile.on_ground(raw, 0.5 * (patch.x0 + patch.x1), 0.5 * (patch.y0 + patch.y1));
  const double square = j.u_x * j.u_x + j.u_y * j.u_y + j.v_x * j.v_x + j.v_y * j.v_y;
  const double det = std::abs(j.determinant());
  const double longest = 0.5 * (square + std::sqrt(std::max(square * square - 4.0 * det * det, 0.0)));
  const double area = static_cast<double>(patch.x1 - patch.x0) * (patch.y1 - patch.y0);
  return {longest > 0.0 ? det / std::sqrt(longest) : 0.0, area * ground, area * std::abs(raw.determinant())};
}

/// True if the tile's pixels are those of a level.
bool are_copies(const std::vector<Patch>& patches, const WarpLevel& level) {
  constexpr double kSame_px = 1e-3;
  const auto near = [](double a, double b) { return std::abs(a - b) < kSame_px; };
  const auto is_whole = [&](double a) { return near(a, std::round(a)); };
  return std::ranges::all_of(patches, [&](const Patch& given) {
    const Patch patch = given.in(level.from_finest);
    const CrsPoint first = patch.at(-1.0, -1.0), end = patch.at(1.0, 1.0);
    return is_whole(first.x) && is_whole(first.y) && near(end.x - first.x, patch.x1 - patch.x0) &&
           near(end.y - first.y, patch.y1 - patch.y0);
  });
}

/// `finer_by` is the factor by which the level is to be finer than the tile.
int level_for(const WarpFrame& frame, const PixelMap& tile, const std::vector<Patch>& patches, double finer_by) {
  std::vector<PatchScale> scales;
  double weight = 0.0, under = 0.0;
  for (const Patch& patch : patches) {
    scales.push_back(scale_of(patch, tile));
    weight += scales.back().weight;
    under += scales.back().under;
  }
  std::ranges::sort(scales, {}, &PatchScale::fewest);
  double passed = 0.0;
  const auto needed = std::ranges::find_if(
      scales, [&](const PatchScale& scale) { return (passed += scale.weight) >= kCoarsePart * weight; });
  const double most = kMostUnder * tile.tile_px * tile.tile_px;
  int level = 0;
  for (int i = 1; i < static_cast<int>(frame.levels.size()); ++i) {
    const double size = frame.levels[static_cast<std::size_t>(i - 1)].pixel_size;
    const double finer = frame.levels[static_cast<std::size_t>(i)].pixel_size;
    if (size * finer_by > needed->fewest * kLevelSlack && under / (finer * finer) <= most) level = i;
  }
  return level;
}

/// Whole pixels that contain a box widened by the reach of a filter.
PixelRect64 whole(const PixelBox& box, double reach_u, double reach_v) {
  const auto low = [](double x) { return static_cast<std::int64_t>(std::floor(std::clamp(x, -1e15, 1e15) + kSliver)); };
  const auto high = [](double x) { return static_cast<std::int64_t>(std::ceil(std::clamp(x, -1e15, 1e15) - kSliver)); };
  return {low(box.u0 - reach_u), low(box.v0 - reach_v), high(box.u1 + reach_u), high(box.v1 + reach_v)};
}

PixelRect64 joined(const PixelRect64& a, const PixelRect64& b) {
  return {std::min(a.u0, b.u0), std::min(a.v0, b.v0), std::max(a.u1, b.u1), std::max(a.v1, b.v1)};
}
double pixels_in(const PixelRect64& rect) {
  return static_cast<double>(rect.width()) * static_cast<double>(rect.height());
}

/// Source pixels that the filter of a patch reaches.
PixelRect64 reach_of(const Patch& patch) {
  double u = 2.0, v = 2.0;
  for (int k = 0; k < 9; ++k) {
    const KernelShape shape = kernel_shape(patch.jacobian(k % 3 - 1.0, k / 3 - 1.0));
    u = std::max(u, shape.reach_u());
    v = std::max(v, shape.reach_v());
  }
  PixelBox box = patch.box();
  if (patch.x1 - patch.x0 == 1 && patch.y1 - patch.y0 == 1) {
    const CrsPoint centre = patch.at(0.0, 0.0);
    box = {centre.x, centre.y, centre.x, centre.y};
  }
  return whole(box, 1.05 * u + 1.0, 1.05 * v + 1.0);
}

class Planner {
 public:
  Planner(const WarpFrame& frame, WarpPlan& plan)
      : plan_(plan), level_(frame.levels[static_cast<std::size_t>(plan.level)]) {}

  bool add_lines(const std::vector<Patch>& patches) {
    const auto found = find_lines(patches, plan_.tile_px);
    if (!found) return false;
    WarpLines lines;
    const double width = level_.area.is_cyclic() ? 0.0 : level_.area.width_px;
    PixelBox under{};
    if (!take(found->columns, width, lines.columns, lines.canvas.u0, lines.canvas.u1, under.u0, under.u1)) return true;
    if (!take(found->rows, level_.area.height_px, lines.rows, lines.canvas.v0, lines.canvas.v1, under.v0, under.v1)) {
      return true;
    }
    if (pixels_in(lines.canvas) > kMostUnder * plan_.tile_px * plan_.tile_px) return false;
    for (LineTaps& column : lines.columns) column.taps.first -= lines.canvas.u0;
    for (LineTaps& row : lines.rows) row.taps.first -= lines.canvas.v0;
    add_pieces(lines.canvas, false);
    add_pieces(whole(under, 0.0, 0.0), true);
    plan_.lines = std::move(lines);
    return true;
  }

  void add_chunks(const std::vector<Patch>& patches) {
    for (const Patch& patch : patches) add_chunk(patch);
  }

  void finish() {
    for (const TileId& id : reached_) plan_.pieces.push_back({id, core_.contains(id)});
  }

 private:
  /// Makes taps of lines, and finds the source pixels that they reach and that lie under them. False if there are none.
  static bool take(const std::vector<Line>& lines, double size, std::vector<LineTaps>& taps, std::int64_t& first,
                   std::int64_t& end, double& under_first, double& under_end) {
    bool any = false;
    for (const Line& line : lines) {
      taps.push_back(std::isnan(line.middle) ? LineTaps{} : line_taps(line, size));
      const Taps& made = taps.back().taps;
      if (made.weights.empty()) continue;
      const auto after = made.first + static_cast<std::int64_t>(made.weights.size());
      const auto [low, high] = std::minmax(line.before, line.after);
      first = any ? std::min(first, made.first) : made.first;
      end = any ? std::max(end, after) : after;
      under_first = any ? std::min(under_first, low) : low;
      under_end = any ? std::max(under_end, high) : high;
      any = true;
    }
    return any;
  }

  void add_pieces(const PixelRect64& rect, bool core) {
    for_each_part(level_, plan_.level, rect, [&](const BlockPart& part) {
      reached_.insert(part.block);
      if (core) core_.insert(part.block);
    });
  }

  void add_chunk(const Patch& patch) {
    const PixelRect64 rect = reach_of(patch);
    const int width = patch.x1 - patch.x0, height = patch.y1 - patch.y0;
    if (pixels_in(rect) > kMostCanvas && width * height > 1) {
      const bool by_columns = width >= height;
      const int x = by_columns ? patch.x0 + width / 2 : patch.x1, y = by_columns ? patch.y1 : patch.y0 + height / 2;
      add_chunk(patch.part(patch.x0, patch.y0, x, y));
      add_chunk(by_columns ? patch.part(x, patch.y0, patch.x1, patch.y1) : patch.part(patch.x0, y, patch.x1, patch.y1));
      return;
    }
    add_pieces(rect, false);
    add_pieces(whole(patch.box(), 0.0, 0.0), true);
    if (!plan_.chunks.empty()) {
      WarpChunk& last = plan_.chunks.back();
      const PixelRect64 both = joined(last.canvas, rect);
      if (pixels_in(both) <= kMostCanvas && pixels_in(both) <= 1.5 * (pixels_in(last.canvas) + pixels_in(rect))) {
        last.canvas = both;
        last.patches.push_back(patch);
        return;
      }
    }
    plan_.chunks.push_back({rect, {patch}});
  }

  WarpPlan& plan_;
  const WarpLevel& level_;
  std::set<TileId> reached_, core_;
};

}  // namespace

WarpPlan plan_tile(const PixelMap& tile, const WarpFrame& frame) {
  WarpPlan plan{.tile_px = tile.tile_px, .rows = tile.rows, .pieces = {}, .lines = {}, .chunks = {}};
  std::vector<Patch> patches = tile_patches(tile, frame.levels.back().area);
  if (patches.empty()) return plan;
  plan.level = level_for(frame, tile, patches, 1.0);
  if (frame.detail == Detail::full && !are_copies(patches, frame.levels[static_cast<std::size_t>(plan.level)])) {
    plan.level = level_for(frame, tile, patches, std::numbers::sqrt2);
  }
  const Affine& from_finest = frame.levels[static_cast<std::size_t>(plan.level)].from_finest;
  for (Patch& patch : patches) patch = patch.in(from_finest);
  Planner planner(frame, plan);
  if (!planner.add_lines(patches)) planner.add_chunks(patches);
  planner.finish();
  return plan;
}

}  // namespace terrella
