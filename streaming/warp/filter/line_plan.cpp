#include "streaming/warp/filter/line_plan.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace terrella {
namespace {

/// Largest deviation from lines, source pixels.
constexpr double kStraight_px = 0.005;

/// Positions along one direction at half pixels of the tile.
class HalfSteps {
 public:
  explicit HalfSteps(int tile_px)
      : at_(static_cast<std::size_t>(2 * tile_px + 1), std::numeric_limits<double>::quiet_NaN()) {}

  /// Adds the positions of a patch from `first` to `end`, given as a parabola over [-1, 1]. False if others are there.
  bool add(int first, int end, double c0, double c1, double c2) {
    for (int k = 2 * first; k <= 2 * end; ++k) {
      const double s = static_cast<double>(k - first - end) / (end - first);
      const double value = (c2 * s + c1) * s + c0;
      double& known = at_[static_cast<std::size_t>(k)];
      if (std::isnan(known)) known = value;
      if (!(std::abs(known - value) <= kStraight_px)) return false;
    }
    return true;
  }
  [[nodiscard]] std::vector<Line> lines() const {
    std::vector<Line> lines;
    for (std::size_t k = 0; k + 2 < at_.size(); k += 2) lines.push_back({at_[k], at_[k + 1], at_[k + 2]});
    return lines;
  }

 private:
  std::vector<double> at_;
};

double size_of(std::span<const double> c, std::initializer_list<std::size_t> which) {
  double sum = 0.0;
  for (const std::size_t k : which) sum += std::abs(c[k]);
  return sum;
}

std::int64_t count_set(const std::vector<Line>& lines) {
  return std::ranges::count_if(lines, [](const Line& line) { return !std::isnan(line.middle); });
}

}  // namespace

std::optional<TileLines> find_lines(const std::vector<Patch>& patches, int tile_px) {
  HalfSteps columns(tile_px), rows(tile_px);
  std::int64_t pixels = 0;
  for (const Patch& patch : patches) {
    if (!(size_of(patch.u, {3, 4, 5, 6, 7, 8}) <= kStraight_px)) return {};
    if (!(size_of(patch.v, {1, 2, 4, 5, 7, 8}) <= kStraight_px)) return {};
    if (!columns.add(patch.x0, patch.x1, patch.u[0], patch.u[1], patch.u[2])) return {};
    if (!rows.add(patch.y0, patch.y1, patch.v[0], patch.v[3], patch.v[6])) return {};
    pixels += std::int64_t{patch.x1 - patch.x0} * (patch.y1 - patch.y0);
  }
  TileLines lines{columns.lines(), rows.lines()};
  if (count_set(lines.columns) * count_set(lines.rows) != pixels) return {};
  return lines;
}

}  // namespace terrella
