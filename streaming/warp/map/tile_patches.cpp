#include "streaming/warp/map/tile_patches.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace terrella {
namespace {

/// Most error at the test points of a patch, source pixels. Between them it is at most a tenth larger. Five times as
/// much adds 1 % to the error of a tile; less gains nothing and costs more patches.
constexpr double kMostError_px = 0.001;
/// A patch is not larger, so that its nodes do not miss a whole wave.
constexpr double kMostSpan_deg = 30.0;
/// An area of this size without a point of the map at its nodes has none at all.
constexpr double kEmptySpan_deg = 6.0;
bool has_place(const CrsPoint& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

class Refiner {
 public:
  Refiner(const PixelMap& tile, const RasterArea& raster) : tile_(tile), raster_(raster), cyclic_(raster.is_cyclic()) {
    refine(0, 0, tile.tile_px, tile.rows);
  }
  std::vector<Patch> patches;

 private:
  void look_up(std::span<const CrsPoint> tile_px, std::span<CrsPoint> out) {
    std::vector<CrsPoint> places;
    std::vector<std::size_t> unknown;
    for (std::size_t i = 0; i < tile_px.size(); ++i) {
      const auto known = known_.find(key(tile_px[i]));
      if (known != known_.end()) {
        out[i] = known->second;
      } else {
        places.push_back(tile_px[i]);
        unknown.push_back(i);
      }
    }
    std::vector<CrsPoint> found(places.size());
    tile_.pixels(places, found);
    for (std::size_t i = 0; i < unknown.size(); ++i) {
      out[unknown[i]] = known_[key(tile_px[unknown[i]])] = found[i];
    }
  }
  /// Nodes and test points lie at quarters of pixels.
  static std::uint64_t key(const CrsPoint& at) {
    return static_cast<std::uint64_t>(at.x * 4.0) << 32U | static_cast<std::uint64_t>(at.y * 4.0);
  }

  void refine(int x0, int y0, int x1, int y1) {
    if (x0 >= x1 || y0 >= y1) return;
    std::array<CrsPoint, 9> at{}, nodes{};
    for (int k = 0; k < 9; ++k) {
      at[static_cast<std::size_t>(k)] = {x0 + 0.5 * (k % 3) * (x1 - x0), y0 + 0.5 * (k / 3) * (y1 - y0)};
    }
    look_up(at, nodes);
    const double span = std::max(x1 - x0, y1 - y0) * tile_.pixel_deg;
    const auto placed = std::ranges::count_if(nodes, has_place);
    const bool single = x1 - x0 == 1 && y1 - y0 == 1;
    if (placed == 0 && (single || span <= kEmptySpan_deg)) return;
    if (placed == 9 && span <= kMostSpan_deg) {
      const Patch patch = Patch::through(x0, y0, x1, y1, nodes);
      if (turns_to(patch, 0.5).empty()) return;
      if (is_true(patch) && keep(patch, single)) return;
    }
    if (single) {
      keep_pixel(x0, y0, nodes[4]);
      return;
    }
    split(x0, y0, x1, y1);
  }

  void split(int x0, int y0, int x1, int y1) {
    const int x = x1 - x0 > 1 ? (x0 + x1) / 2 : x1;
    const int y = y1 - y0 > 1 ? (y0 + y1) / 2 : y1;
    refine(x0, y0, x, y);
    refine(x, y0, x1, y);
    refine(x0, y, x, y1);
    refine(x, y, x1, y1);
  }

  /// Compares the patch with the map between its nodes. An overview is used where the tile is coarser than the raster;
  /// its pixels are larger.
  [[nodiscard]] bool is_true(const Patch& patch) {
    std::array<CrsPoint, 4> at{}, truth{};
    for (int k = 0; k < 4; ++k) {
      at[static_cast<std::size_t>(k)] = {patch.x0 + (0.25 + 0.5 * (k % 2)) * (patch.x1 - patch.x0),
                                         patch.y0 + (0.25 + 0.5 * (k / 2)) * (patch.y1 - patch.y0)};
    }
    look_up(at, truth);
    const double scale = std::sqrt(std::abs(patch.jacobian(0.0, 0.0).determinant()));
    const double most = kMostError_px * std::max(1.0, 0.5 * scale);
    for (int k = 0; k < 4; ++k) {
      const CrsPoint made = patch.at(k % 2 - 0.5, k / 2 - 0.5), is = truth[static_cast<std::size_t>(k)];
      if (!(std::abs(made.x - is.x) <= most && std::abs(made.y - is.y) <= most)) return false;
    }
    return true;
  }

  /// The turns to add to a patch so that it meets the raster. `slack` widens the patch by that part of its size.
  [[nodiscard]] std::vector<int> turns_to(const Patch& patch, double slack) const {
    PixelBox box = patch.box();
    const Jacobian j = patch.jacobian(0.0, 0.0);
    const double by_u = slack * (box.u1 - box.u0) + std::abs(j.u_x) + std::abs(j.u_y) + 1.0;
    const double by_v = slack * (box.v1 - box.v0) + std::abs(j.v_x) + std::abs(j.v_y) + 1.0;
    box = {box.u0 - by_u, box.v0 - by_v, box.u1 + by_u, box.v1 + by_v};
    const CrsPoint turn = raster_.turn_px.value_or(CrsPoint{});
    const auto meets = [&](double k) {
      return box.u0 + k * turn.x <= raster_.width_px && box.u1 + k * turn.x >= 0.0 &&
             box.v0 + k * turn.y <= raster_.height_px && box.v1 + k * turn.y >= 0.0;
    };
    std::vector<int> turns;
    if (!raster_.turn_px) {
      if (meets(0.0)) turns.push_back(0);
      return turns;
    }
    const bool by_columns = std::abs(turn.x) >= std::abs(turn.y);
    const double middle = by_columns ? (0.5 * raster_.width_px - 0.5 * (box.u0 + box.u1)) / turn.x
                                     : (0.5 * raster_.height_px - 0.5 * (box.v0 + box.v1)) / turn.y;
    const double reach = by_columns ? (raster_.width_px + box.u1 - box.u0) / std::abs(turn.x)
                                    : (raster_.height_px + box.v1 - box.v0) / std::abs(turn.y);
    if (!(std::abs(middle) < 1e6 && reach < 1e3)) return turns;
    for (double k = std::floor(middle - reach); k <= middle + reach; ++k) {
      if (meets(k)) turns.push_back(static_cast<int>(k));
    }
    return turns;
  }

  void add(Patch patch, double turns) {
    const CrsPoint turn = raster_.turn_px.value_or(CrsPoint{});
    patch.u[0] += turns * turn.x;
    patch.v[0] += turns * turn.y;
    patches.push_back(patch);
  }

  /// Keeps a patch that meets the raster in one turn. Returns false if it has to be split.
  bool keep(const Patch& patch, bool single) {
    const std::vector<int> turns = turns_to(patch, 0.0);
    if (turns.size() == 1 || (cyclic_ && !turns.empty())) {
      add(patch, cyclic_ ? onto_first_turn(patch) : turns[0]);
      return true;
    }
    if (turns.size() > 1 && !single) return false;
    if (turns.size() > 1) add(patch, nearest_turn(patch, turns));
    return true;
  }

  [[nodiscard]] double onto_first_turn(const Patch& patch) const {
    const double columns = raster_.turn_px->x;
    return std::copysign(1.0, columns) * -std::floor(patch.u[0] / std::abs(columns));
  }

  /// The turn that brings the middle of a patch onto the raster.
  [[nodiscard]] int nearest_turn(const Patch& patch, const std::vector<int>& turns) const {
    const auto off = [&](int k) {
      const double u = patch.u[0] + k * raster_.turn_px->x, v = patch.v[0] + k * raster_.turn_px->y;
      return std::max({-u, u - raster_.width_px, -v, v - raster_.height_px});
    };
    return *std::ranges::min_element(turns, {}, off);
  }

  /// A pixel on whose edges the map is torn. Slopes are those of the side that is not torn.
  void keep_pixel(int x, int y, const CrsPoint& centre) {
    if (!has_place(centre)) return;
    constexpr double kStep = 1.0 / 64.0;
    const double cx = x + 0.5, cy = y + 0.5;
    const std::array<CrsPoint, 4> around{{{cx - kStep, cy}, {cx + kStep, cy}, {cx, cy - kStep}, {cx, cy + kStep}}};
    std::array<CrsPoint, 4> found{};
    tile_.pixels(around, found);
    const auto slope = [&](std::size_t first) {
      const CrsPoint before{centre.x - found[first].x, centre.y - found[first].y};
      const CrsPoint after{found[first + 1].x - centre.x, found[first + 1].y - centre.y};
      const CrsPoint least = std::hypot(before.x, before.y) <= std::hypot(after.x, after.y) ? before : after;
      return has_place(least) ? CrsPoint{least.x / kStep, least.y / kStep} : CrsPoint{};
    };
    const CrsPoint by_x = slope(0), by_y = slope(2);
    Patch patch{x, y, x + 1, y + 1};
    patch.u[0] = centre.x;
    patch.v[0] = centre.y;
    patch.u[1] = 0.5 * by_x.x;
    patch.v[1] = 0.5 * by_x.y;
    patch.u[3] = 0.5 * by_y.x;
    patch.v[3] = 0.5 * by_y.y;
    keep(patch, true);
  }

  const PixelMap& tile_;
  const RasterArea& raster_;
  const bool cyclic_;
  std::unordered_map<std::uint64_t, CrsPoint> known_;
};

}  // namespace

bool RasterArea::is_cyclic() const {
  constexpr double kWhole_px = 0.01;
  if (!turn_px || std::abs(turn_px->y) > kWhole_px) return false;
  const double columns = std::abs(turn_px->x);
  return columns >= 1.0 && std::abs(columns - std::round(columns)) <= kWhole_px && width_px >= columns - kWhole_px;
}

std::vector<Patch> tile_patches(const PixelMap& tile, const RasterArea& raster) {
  return Refiner(tile, raster).patches;
}

}  // namespace terrella
