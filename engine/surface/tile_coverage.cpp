#include "surface/tile_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

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

// Entries looked up in this frame. Cells side by side climb through the same ancestors, so some remembered entries a
// level save most walks through the hash table. Nothing is erased while a frame's cells are found.
class EntryMemo {
 public:
  EntryMemo(const TileGrid& grid, TileResidency& residency) : grid_(grid), residency_(residency) {}

  struct Line {
    TileId id{-1, 0, 0};  ///< in the full grid
    bool squeezed = false;
    TileId tile;  ///< that stands for it (reduced_tile())
    TileResidency::Entry* entry = nullptr;
    bool judged = false;
  };

  /// Without an entry where none was ever made: then the tile is unknown. Valid until the next call.
  [[nodiscard]] const Line& find(const TileId& id, bool squeezed) {
    Line& line = line_of(id);
    if (line.id == id && line.squeezed == squeezed) return line;
    const TileId tile = squeezed ? reduced_tile(grid_, id) : id;
    line = {id, squeezed, tile, residency_.find(tile), false};
    return line;
  }
  /// Made if it is not there; a tile that the grid does not have is told apart from one not asked for.
  [[nodiscard]] const Line& judged(const TileId& id, bool squeezed) {
    Line& line = line_of(id);
    if (line.id == id && line.squeezed == squeezed && line.judged) return line;
    const TileId tile = squeezed ? reduced_tile(grid_, id) : id;
    TileResidency::Entry& entry = residency_.entry(tile);
    if (entry.state == TileState::unknown && !exists(grid_, tile)) entry.state = TileState::outside;
    line = {id, squeezed, tile, &entry, true};
    return line;
  }

 private:
  [[nodiscard]] Line& line_of(const TileId& id) {
    const std::int64_t place = (id.x & 7) | (id.y & 3) << 3;
    return lines_[static_cast<std::size_t>(id.level)][static_cast<std::size_t>(place)];
  }

  const TileGrid& grid_;
  TileResidency& residency_;
  std::array<std::array<Line, 32>, kMaxTileLevel + 1> lines_;
};

class Coverer {
 public:
  Coverer(PatchTree& tree, const View& view, TileResidency& residency, std::uint64_t frame, TileCoverage& out,
          double texels_per_pixel, OutOfBounds out_of_bounds)
      : tree_(tree),
        view_(view),
        memo_(tree.grid(), residency),
        frame_(frame),
        out_(out),
        planes_(view_planes(view)),
        out_of_bounds_(out_of_bounds) {
    const Ellipsoid& e = tree.ellipsoid();
    radians_per_pixel_ = 1.0 / view.pixels_per_radian();
    const double texel0_m = e.a_m() * (std::numbers::pi / 180.0) * tree.grid().root_span_deg / tree.grid().tile_px;
    texel0_asked_m_ = texel0_m * texels_per_pixel;
    most_asked_ = texels_per_pixel;
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
        if (choice.entry != nullptr) choice.entry->last_chosen = 0;
      }
      choose_levels(patches);
    }
    const Choice* choice = choices_.data();
    for (const SelectedPatch& patch : patches) {
      cover(patch, choice);
      choice += patch.node->window.cells.size();
    }
  }

 private:
  /// What a cell would take by itself.
  struct Choice {
    TileResidency::Entry* entry = nullptr;  ///< none: the cell is out of view
    int spare = 0;                          ///< levels coarser than the window
  };

  void choose_levels(const std::vector<SelectedPatch>& patches) {
    choices_.clear();
    for (const SelectedPatch& patch : patches) choose_levels(patch);
  }

  void choose_levels(const SelectedPatch& patch) {
    const TileWindow& win = tree_.window(*patch.node, patch.tile_level, patch.squeeze);
    const TileId last = last_tile(win.level);
    for (int y = 0; y < win.h; ++y) {
      for (int x = 0; x < win.w; ++x) {
        Choice& choice = choices_.emplace_back();
        if (!in_view(patch, x, y)) continue;
        const TileId id = tile_of(win, x, y, last);
        choice.spare = levels_to_spare(id, texels_wanted(win.cells[index(win, x, y)]));
        choice.entry = memo_.judged(ancestor(id, choice.spare), patch.squeezed || choice.spare > 0).entry;
        if (choice.entry->last_chosen != frame_) ++chosen_;
        choice.entry->last_chosen = frame_;
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

  void cover(const SelectedPatch& patch, const Choice* choice) {
    const TileWindow& win = patch.node->window;
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
  // pixel. Close to a pole what lies along the meridian is all that a picture lacks.
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

  [[nodiscard]] bool in_view(const SelectedPatch& patch, int x, int y) {
    if (!patch.cut_by_view) return true;
    const PatchNode& node = *patch.node;
    const CellExtent& cell = node.window.cells[index(node.window, x, y)];
    const PatchRelief& relief = node.relief;
    const BoundingSphere whole{
        cell.whole.center_m + relief.middle_m * cell.up,
        cell.whole.radius_m * (1.0 + std::abs(relief.middle_m) * least_radius_per_m_) + relief.half_m};
    const unsigned cut = beyond(whole.center_m, -whole.radius_m, limits_);
    if (cut == 0 || beyond(whole.center_m, 0.0, cut) == 0) return true;
    if (beyond(whole.center_m, whole.radius_m, cut) != 0) return false;
    return part_in_view(tree_.cell_lattice(*patch.node, x, y), std::abs(relief.middle_m) + relief.half_m, cut);
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
      const EntryMemo::Line& line = memo_.find(id, patch.squeezed || up > 0);
      if (line.entry != nullptr && line.entry->state == TileState::resident) return drawn(line, up);
      if (id.level <= tree_.grid().min_level) return {up, line.tile.squeeze, 0, false};
    }
  }

  Found find(const SelectedPatch& patch, const TileId& id, const Choice& choice) {
    if (choice.entry == nullptr) return find_unseen(patch, id);
    TileId finer = id;
    for (int up = 0; up < choice.spare; ++up, finer = parent(finer)) {
      const EntryMemo::Line& line = memo_.find(finer, patch.squeezed || up > 0);
      if (line.entry != nullptr && line.entry->last_chosen == frame_) return find_seen(patch, finer, up);
    }
    return find_seen(patch, finer, choice.spare);
  }

  // From a tile, `up` levels coarser than the window, upwards.
  Found find_seen(const SelectedPatch& patch, TileId id, int up) {
    bool counted = false;
    bool in_bounds = true;
    bool asked = false;  // one tile is asked for: the finest that can still come
    for (;;) {
      const EntryMemo::Line& line = memo_.judged(id, patch.squeezed || up > 0);
      TileResidency::Entry& entry = *line.entry;
      if (entry.state == TileState::outside && out_of_bounds_ == OutOfBounds::nothing) {
        return {up, line.tile.squeeze, 0, false};
      }
      if (entry.state == TileState::outside) in_bounds = in_bounds && counted;
      if (!counted && entry.state != TileState::outside) {
        counted = true;
        count(entry);
      }
      if (entry.state == TileState::resident) {
        if (!asked) entry.last_needed = frame_;
        out_.shown = out_.shown || in_bounds;
        return drawn(line, up);
      }
      if (!asked && entry.state == TileState::unknown) {
        asked = true;
        want(patch, line.tile, entry);
      }
      if (id.level <= tree_.grid().min_level) return {up, line.tile.squeeze, 0, true};
      id = parent(id);
      ++up;
    }
  }

  [[nodiscard]] Found drawn(const EntryMemo::Line& line, int levels_up) const {
    line.entry->last_drawn = frame_;
    return {levels_up, line.tile.squeeze, line.entry->slot, false};
  }

  void want(const SelectedPatch& patch, const TileId& id, TileResidency::Entry& entry) {
    if (entry.last_wanted == frame_) return;
    entry.last_wanted = frame_;
    const BoundingSphere& sphere = patch.node->sphere;
    const double depth = std::max(1.0, glm::dot(sphere.center_m - view_.eye.xyz_m, view_.forward));
    out_.wanted.push_back({id, -id.level + sphere.radius_m / (depth + sphere.radius_m)});
  }

  void count(TileResidency::Entry& entry) {
    if (entry.last_counted == frame_) return;
    entry.last_counted = frame_;
    ++out_.tiles;
    if (entry.state == TileState::unknown) ++out_.missing;
    if (entry.state == TileState::missing) ++out_.lacking;
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

  PatchTree& tree_;
  const View& view_;
  EntryMemo memo_;
  std::uint64_t frame_;
  TileCoverage& out_;
  ViewPlanes planes_;
  OutOfBounds out_of_bounds_;
  glm::dvec3 eye_over_axes2_{0.0};
  double least_radius_per_m_ = 0.0;
  double horizon_ = 1.0;        ///< what the dot product is, at least, of what some eye sees
  double horizon_per_m_ = 0.0;  ///< what a metre is, at most, in the horizon's dot product
  unsigned limits_ = kAllLimits;
  std::vector<Choice> choices_;  ///< of all cells in order
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

void cover_with_tiles(PatchTree& tree, const View& view, const std::vector<SelectedPatch>& patches,
                      TileResidency& residency, std::uint64_t frame, TileCoverage& out, double texels_per_pixel,
                      OutOfBounds out_of_bounds) {
  out.draws.clear();
  out.cells.clear();
  out.wanted.clear();
  out.tiles = out.missing = out.lacking = out.uncovered = 0;
  out.shown = false;
  Coverer coverer(tree, view, residency, frame, out, texels_per_pixel, out_of_bounds);
  coverer.cover(patches);
}

}  // namespace terrella
