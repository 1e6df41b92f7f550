#include "surface/tile_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "geo/scaled_space.h"

namespace terrella {
namespace {

// A level is coarse enough if its texels are at most 2^0.02 pixels: a rounding of 1.4 % spares half of the borderline
// tiles.
constexpr double kLevelRounding = 0.02;
// A cell larger than this part of its distance has pixels of too different size to be judged by its middle.
constexpr double kLargeCell = 0.25;
// A picture of the equator wants twice as many texels as it has pixels; one of the pole, of a full grid, six times.
// Over this, and of more tiles than these, it gives way (cold_view.py, bench accuracy).
constexpr double kMostTexelsAPixel = 5.5;
constexpr int kFewTiles = 64;
// To texels so long along the meridian, in pixels, but from where they are about a quarter as wide as long.
constexpr double kLongestTexel_px = 1.55, kCloseToPole = 0.07;

// Uses looked up in this plan. Cells side by side climb through the same ancestors, so some remembered uses a level
// save most walks through the hash table.
class UseMemo {
 public:
  UseMemo(const TileGrid& grid, const TileResidency& residency, TileUses& uses)
      : grid_(grid), residency_(residency), uses_(uses) {}

  /// The use of the tile that stands for `id` of the full grid (reduced_tile()).
  [[nodiscard]] std::uint32_t find(const TileId& id, bool squeezed) {
    Line& line = lines_[static_cast<std::size_t>(id.level)][static_cast<std::size_t>((id.x & 7) | (id.y & 3) << 3)];
    if (line.x != id.x || line.y != id.y || line.squeezed != squeezed) {
      line = {id.x, id.y, uses_.find(squeezed ? reduced_tile(grid_, id) : id, residency_), squeezed};
    }
    return line.use;
  }
  /// The same for a cell in view. Tells a tile that the grid does not have from one that was never requested.
  [[nodiscard]] std::uint32_t judged(const TileId& id, bool squeezed) {
    const std::uint32_t index = find(id, squeezed);
    TileUse& use = uses_[index];
    if (!std::exchange(use.judged, true) && use.state == TileState::unknown && !exists(grid_, use.id)) {
      use.state = TileState::outside;
    }
    return index;
  }

 private:
  struct Line {
    std::int64_t x = -1, y = -1;
    std::uint32_t use = 0;
    bool squeezed = false;
  };

  const TileGrid& grid_;
  const TileResidency& residency_;
  TileUses& uses_;
  std::array<std::array<Line, 32>, kMaxTileLevel + 1> lines_;
};

class Coverer {
 public:
  Coverer(const CoverInput& input, TileCoverage& out)
      : tree_(input.tree),
        growth_(input.growth),
        view_(input.view),
        memo_(input.tree.grid(), input.residency, out.uses),
        out_(out),
        planes_(view_planes(input.view)),
        out_of_bounds_(input.out_of_bounds) {
    const PatchTree& tree = input.tree;
    const View& view = input.view;
    const Ellipsoid& e = tree.ellipsoid();
    radians_per_pixel_ = 1.0 / view.pixels_per_radian();
    const double texel0_m = e.a_m() * (std::numbers::pi / 180.0) * tree.grid().root_span_deg / tree.grid().tile_px;
    texel0_asked_m_ = texel0_m * input.texels_per_pixel;
    most_asked_ = input.texels_per_pixel;
    const glm::dvec3 eye_scaled = view.eye.xyz_m / semi_axes_m(e);
    eye_over_axes2_ = eye_scaled / semi_axes_m(e);
    horizon_per_m_ = glm::length(eye_scaled) / e.b_m();
    least_radius_per_m_ = 2.0 / e.b_m();
    horizon_ = 1.0 - view.eye_spread_m / e.b_m();
    if (glm::dot(eye_scaled, eye_scaled) <= 1.0 || tree.relief() != nullptr) limits_ &= ~kHorizon;
  }

  // First which tile each cell would take, then the tiles: a cell that could do with a coarser one takes the finer one
  // where another cell asks for that anyhow.
  void cover(const std::vector<SelectedPatch>& patches) {
    choose_levels(patches);
    if (too_many_texels()) {
      narrow_texels_are_long_ = true;
      for (const Choice& choice : choices_) {
        if (choice.use != kUnseen) out_.uses[choice.use].chosen = false;
      }
      choose_levels(patches);
    }
    out_.draws.reserve(patches.size());
    out_.cells.reserve(choices_.size());
    const Choice* choice = choices_.data();
    for (std::size_t k = 0; k < patches.size(); ++k) {
      cover(patches[k], *windows_[k], choice);
      choice += windows_[k]->cells.size();
    }
  }

 private:
  static constexpr std::uint32_t kUnseen = ~0U;  ///< the cell is out of view
  /// What a cell would take by itself.
  struct Choice {
    std::uint32_t use = kUnseen;
    int spare = 0;  ///< levels coarser than the window
  };

  void choose_levels(const std::vector<SelectedPatch>& patches) {
    choices_.clear();
    windows_.clear();
    windows_.reserve(patches.size());
    choices_.reserve(2 * patches.size());
    for (const SelectedPatch& patch : patches) choose_levels(patch);
  }

  void choose_levels(const SelectedPatch& patch) {
    const TileWindow& win = growth_.window(*patch.node, patch.tile_level, patch.squeeze);
    windows_.push_back(&win);
    const TileId last = last_tile(win.level);
    for (int y = 0; y < win.h; ++y) {
      for (int x = 0; x < win.w; ++x) {
        Choice& choice = choices_.emplace_back();
        if (!in_view(patch, win, x, y)) continue;
        const TileId id = tile_of(win, x, y, last);
        choice.spare = levels_to_spare(id, texels_wanted(win.cells[index(win, x, y)]));
        choice.use = memo_.judged(ancestor(id, choice.spare), patch.squeezed || choice.spare > 0);
        if (!std::exchange(out_.uses[choice.use].chosen, true)) ++chosen_;
      }
    }
  }

  // How many texels of level 0 a pixel asks for along the meridian and, of the full grid, along the parallel.
  struct TexelsWanted {
    double meridian, parallel;
  };

  [[nodiscard]] int levels_to_spare(const TileId& id, const TexelsWanted& wanted) const {
    const TileGrid& grid = tree_.grid();
    int spare = 0;
    for (double most = std::exp2(id.level - 1 + kLevelRounding); spare < id.level - grid.min_level; most *= 0.5) {
      const int squeeze = grid.reduced ? squeeze_of_row(grid, id.level - spare - 1, id.y >> (spare + 1)) : 0;
      if (std::max(wanted.meridian, std::ldexp(wanted.parallel, squeeze)) > most) break;
      ++spare;
    }
    return spare;
  }

  void cover(const SelectedPatch& patch, const TileWindow& win, const Choice* choice) {
    out_.draws.push_back(describe(*patch.node, win, static_cast<std::uint32_t>(out_.cells.size())));
    const TileId last = last_tile(win.level);
    bool uncovered = false;
    for (int y = 0; y < win.h; ++y) {
      for (int x = 0; x < win.w; ++x, ++choice) {
        const Found found = find(patch, tile_of(win, x, y, last), *choice);
        uncovered = uncovered || found.uncovered;
        out_.cells.push_back(window_cell(found.slot, found.levels_up, found.levels_up + found.squeeze - win.squeeze));
      }
    }
    if (uncovered) ++out_.uncovered;
  }

  [[nodiscard]] TileId last_tile(int level) const {
    return {level, columns(tree_.grid(), level) - 1, rows(tree_.grid(), level) - 1};
  }

  // Cells beyond the planet repeat its edge.
  static TileId tile_of(const TileWindow& win, int x, int y, const TileId& last) {
    return {win.level, std::min((win.x0 + x) << win.squeeze, last.x), std::min(win.y0 + y, last.y)};
  }

  static TileId ancestor(TileId id, int levels_up) {
    for (int k = 0; k < levels_up; ++k) id = parent(id);
    return id;
  }

  // In the middle of a cell. A patch has the level of its nearest part; a cell that asks for less takes a coarser one.
  [[nodiscard]] TexelsWanted texels_wanted(const CellExtent& cell) const {
    constexpr double kAll = std::numeric_limits<double>::infinity();
    const glm::dvec3 to_eye = view_.eye.xyz_m - cell.whole.center_m;
    const glm::dvec3& normal = cell.up;
    const double distance_m = std::max(glm::length(to_eye), 1e-9);
    if (cell.whole.radius_m > kLargeCell * distance_m) return {kAll, kAll};
    const double up = std::clamp(glm::dot(to_eye, normal) / distance_m, 0.05, 1.0);
    const double cos_lat2 = std::max(normal.x * normal.x + normal.y * normal.y, 1e-18);
    const double east = (normal.x * to_eye.y - normal.y * to_eye.x) / distance_m;
    const double sine2 = std::min(1.0, east * east / (cos_lat2 * std::max(1e-18, 1.0 - up * up)));
    // A pixel on the ground is `across` wide and across/up long, its length at an angle to the meridian of which sine2
    // is the sine squared; it resolves along an axis what the ellipse of its frequencies reaches there.
    const double north2 = (1.0 - sine2) * up * up + sine2, parallel2 = sine2 * up * up + 1.0 - sine2;
    const double texels = texel0_asked_m_ / (distance_m * radians_per_pixel_);
    return {texels * std::sqrt(north2) / length_px(cos_lat2), texels * std::sqrt(cos_lat2 * parallel2)};
  }

  // Tiles of a full grid are ever narrower towards a pole, and a view from over it wants many that it hardly shows.
  [[nodiscard]] bool too_many_texels() const {
    const TileGrid& grid = tree_.grid();
    const double texels = double(chosen_) * grid.tile_px * grid.tile_px;
    const double pixels = double(view_.viewport.width_px) * view_.viewport.height_px;
    return !grid.reduced && chosen_ > kFewTiles && texels > kMostTexelsAPixel * most_asked_ * most_asked_ * pixels;
  }

  // How many pixels long a texel may be along the meridian: in a view of too many, as long as it covers no more than a
  // pixel. Close to a pole only detail along the meridian is missing in a picture.
  [[nodiscard]] double length_px(double cos_lat2) const {
    if (!narrow_texels_are_long_ || cos_lat2 < kCloseToPole) return 1.0;
    return std::min(kLongestTexel_px, 1.0 / std::sqrt(std::sqrt(cos_lat2)));
  }

  struct Found {
    int levels_up = 0;
    int squeeze = 0;
    int slot = 0;
    bool uncovered = false;
  };

  static std::size_t index(const TileWindow& win, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(win.w) + static_cast<std::size_t>(x);
  }

  // The limits of the view, a bit each: the four side planes and the horizon.
  static constexpr unsigned kHorizon = 16U, kAllLimits = 31U;

  // Of those, the ones that all of what is within `reach_m` of a point lies beyond, or some of it (reach negative).
  [[nodiscard]] unsigned beyond(const glm::dvec3& p_m, double reach_m, unsigned limits) const {
    unsigned sides = 0;
    const glm::dvec3 from_eye = p_m - view_.eye.xyz_m;
    for (std::size_t k = 0; k < planes_.normals.size(); ++k) {
      if ((limits & 1U << k) != 0 && glm::dot(planes_.normals[k], from_eye) < -reach_m - view_.eye_spread_m)
        sides |= 1U << k;
    }
    // Scaled by the shortest axis what is within reach still is.
    if ((limits & kHorizon) != 0 && glm::dot(p_m, eye_over_axes2_) < horizon_ - reach_m * horizon_per_m_)
      sides |= kHorizon;
    return sides;
  }

  [[nodiscard]] bool in_view(const SelectedPatch& patch, const TileWindow& win, int x, int y) {
    if (!patch.cut_by_view) return true;
    const CellExtent& cell = win.cells[index(win, x, y)];
    const PatchRelief& relief = patch.body().relief;
    const BoundingSphere whole{
        cell.whole.center_m + relief.middle_m * cell.up,
        cell.whole.radius_m * (1.0 + std::abs(relief.middle_m) * least_radius_per_m_) + relief.half_m};
    const unsigned cut = beyond(whole.center_m, -whole.radius_m, limits_);
    if (cut == 0 || beyond(whole.center_m, 0.0, cut) == 0) return true;
    if (beyond(whole.center_m, whole.radius_m, cut) != 0) return false;
    return part_in_view(growth_.lattice(*patch.node, win, x, y), std::abs(relief.middle_m) + relief.half_m, cut);
  }

  // A quad is out of view if one limit has all its corners beyond it.
  [[nodiscard]] bool part_in_view(const SurfaceLattice& lattice, double relief_m, unsigned limits) const {
    constexpr int kSide = kLatticeQuads + 1;
    std::array<unsigned, static_cast<std::size_t>(kSide * kSide)> sides{};
    for (std::size_t k = 0; k < sides.size(); ++k) {
      sides[k] = beyond(lattice.points_m[k], lattice.bulge_m + relief_m, limits);
      if (sides[k] == 0) return true;
      const bool ends_a_quad = k > kSide && k % kSide != 0;
      if (ends_a_quad && (sides[k] & sides[k - 1] & sides[k - kSide] & sides[k - kSide - 1]) == 0) return true;
    }
    return false;
  }

  // A cell out of view takes what is there; nobody asks for its tile or counts it.
  Found find_unseen(const SelectedPatch& patch, TileId id) {
    for (int up = 0;; ++up, id = parent(id)) {
      TileUse& use = out_.uses[memo_.find(id, patch.squeezed || up > 0)];
      if (use.state == TileState::resident) return drawn(use, up);
      if (id.level <= tree_.grid().min_level) return {up, use.id.squeeze, 0, false};
    }
  }

  Found find(const SelectedPatch& patch, const TileId& id, const Choice& choice) {
    if (choice.use == kUnseen) return find_unseen(patch, id);
    TileId finer = id;
    for (int up = 0; up < choice.spare; ++up, finer = parent(finer)) {
      if (out_.uses[memo_.find(finer, patch.squeezed || up > 0)].chosen) return find_seen(patch, finer, up);
    }
    return find_seen(patch, finer, choice.spare);
  }

  // From a tile, `up` levels coarser than the window, upwards.
  Found find_seen(const SelectedPatch& patch, TileId id, int up) {
    bool counted = false;
    bool in_bounds = true;
    bool asked = false;  // one tile is asked for: the finest that can still come
    for (;;) {
      TileUse& use = out_.uses[memo_.judged(id, patch.squeezed || up > 0)];
      if (use.state == TileState::outside && out_of_bounds_ == OutOfBounds::nothing) {
        return {up, use.id.squeeze, 0, false};
      }
      if (use.state == TileState::outside) in_bounds = in_bounds && counted;
      if (!counted && use.state != TileState::outside) {
        counted = true;
        count(use);
      }
      if (use.state == TileState::resident) {
        use.needed = use.needed || !asked;
        out_.shown = out_.shown || in_bounds;
        return drawn(use, up);
      }
      if (!asked && use.state == TileState::unknown) {
        asked = true;
        want(patch, use);
      }
      if (id.level <= tree_.grid().min_level) return {up, use.id.squeeze, 0, true};
      id = parent(id);
      ++up;
    }
  }

  [[nodiscard]] static Found drawn(TileUse& use, int levels_up) {
    use.drawn = true;
    return {levels_up, use.id.squeeze, use.slot, false};
  }

  void want(const SelectedPatch& patch, TileUse& use) {
    if (std::exchange(use.wanted, true)) return;
    const BoundingSphere& sphere = patch.body().sphere;
    const double depth = std::max(1.0, glm::dot(sphere.center_m - view_.eye.xyz_m, view_.forward));
    out_.wanted.push_back({use.id, -use.id.level + sphere.radius_m / (depth + sphere.radius_m)});
  }

  void count(TileUse& use) {
    if (std::exchange(use.counted, true)) return;
    ++out_.tiles;
    if (use.state == TileState::unknown) ++out_.pending;
    if (use.state == TileState::missing) ++out_.missing;
  }

  [[nodiscard]] PatchDraw describe(const PatchNode& node, const TileWindow& win, std::uint32_t first) const {
    const TileGrid& grid = tree_.grid();
    const double row = node.row_center_deg;
    const TileXY center = tile_xy(grid, win.level, row, node.lon_center_deg);
    const double per_deg = 1.0 / tile_span_deg(grid, win.level);
    PatchDraw draw;
    draw.center_and_scale =
        glm::vec4(std::ldexp(center.x, -win.squeeze) - static_cast<double>(win.x0),
                  center.y - static_cast<double>(win.y0), std::ldexp(per_deg, -win.squeeze), per_deg);
    draw.frame = glm::vec4(node.frame);
    draw.row = glm::vec4(row, static_cast<double>(grid.max_level - win.level), 0.0, 0.0);
    const auto low = [](std::int64_t n) { return static_cast<std::uint32_t>(n & 0xFFFFFF); };
    draw.window = glm::uvec4(first, static_cast<std::uint32_t>(win.w) | static_cast<std::uint32_t>(win.h) << 16U,
                             low(win.x0), low(win.y0));
    return draw;
  }

  const PatchTree& tree_;
  TreeGrowth& growth_;
  const View& view_;
  UseMemo memo_;
  TileCoverage& out_;
  ViewPlanes planes_;
  OutOfBounds out_of_bounds_;
  glm::dvec3 eye_over_axes2_{0.0};
  double least_radius_per_m_ = 0.0;
  double horizon_ = 1.0;        ///< what the dot product is, at least, of what some eye sees
  double horizon_per_m_ = 0.0;  ///< what a metre is, at most, in the horizon's dot product
  unsigned limits_ = kAllLimits;
  std::vector<const TileWindow*> windows_;  ///< of the patches in order
  std::vector<Choice> choices_;             ///< of all cells in order
  double radians_per_pixel_ = 0.0;
  int chosen_ = 0;  ///< tiles that cells would take by themselves
  bool narrow_texels_are_long_ = false;
  double most_asked_ = 1.0;      ///< texels a pixel
  double texel0_asked_m_ = 0.0;  ///< a texel of level 0, times the texels a pixel that are asked for
};

}  // namespace

std::vector<TileId> root_tiles(const TileGrid& grid) {
  std::vector<TileId> tiles;
  for (std::int64_t y = 0; y < rows(grid, grid.min_level); ++y) {
    const std::int64_t step = std::int64_t{1} << squeeze_of_row(grid, grid.min_level, y);
    for (std::int64_t x = 0; x < columns(grid, grid.min_level); x += step) {
      const TileId id = reduced_tile(grid, {grid.min_level, x, y});
      if (exists(grid, id)) tiles.push_back(id);
    }
  }
  return tiles;
}

void TileUses::clear() {
  uses_.clear();
  std::ranges::fill(table_, kNone);
}

// Where the tile's index stands, or where it would.
std::size_t TileUses::place(const TileId& id) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t at = TileIdHash{}(id)&mask;
  while (table_[at] != kNone && uses_[table_[at]].id != id) at = (at + 1) & mask;
  return at;
}

void TileUses::grow() {
  table_.assign(std::max<std::size_t>(1024, 2 * table_.size()), kNone);
  uses_.reserve(table_.size() / 2);
  for (std::uint32_t k = 0; k < uses_.size(); ++k) table_[place(uses_[k].id)] = k;
}

std::uint32_t TileUses::find(const TileId& id, const TileResidency& residency) {
  if (2 * (uses_.size() + 1) > table_.size()) grow();
  std::uint32_t& index = table_[place(id)];
  if (index != kNone) return index;
  index = static_cast<std::uint32_t>(uses_.size());
  const TileResidency::Entry* entry = residency.find(id);
  TileUse& use = uses_.emplace_back(TileUse{.id = id});
  if (entry != nullptr) use.state = entry->state, use.slot = entry->slot;
  return index;
}

void cover_with_tiles(const CoverInput& input, TileCoverage& out) {
  out.draws.clear();
  out.cells.clear();
  out.wanted.clear();
  out.uses.clear();
  out.tiles = out.pending = out.missing = out.uncovered = 0;
  out.shown = false;
  Coverer(input, out).cover(input.patches);
}

void note_use(const TileUses& uses, std::uint64_t frame, TileResidency& residency) {
  for (const TileUse& use : uses.all()) {
    if (!use.judged && !use.drawn) continue;
    TileResidency::Entry& entry = residency.entry(use.id);
    entry.last_seen = frame;
    if (use.drawn) entry.last_drawn = frame;
    if (use.needed) entry.last_needed = frame;
    if (use.state == TileState::outside) entry.state = TileState::outside;
  }
}

}  // namespace terrella
