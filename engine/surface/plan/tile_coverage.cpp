#include "surface/plan/tile_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "surface/plan/cell_view.h"
#include "surface/plan/texel_demand.h"

namespace terrella {
namespace {

// Most cells that a shadow adds on a side of a window. Where tiles are so small, the layer is seen from under it soon.
constexpr double kMostBeside = 16.0;

class Coverer {
 public:
  Coverer(const CoverInput& input, TileCoverage& out)
      : input_(input),
        grid_(input.tree.grid()),
        memo_(grid_, input.residency, out.uses),
        out_(out),
        cells_(input.view, input.tree.ellipsoid(), input.has_relief),
        demand_(input.view, input.tree.ellipsoid(), grid_, input.texels_per_pixel) {}

  // First the tile that each cell would take by itself, then the tiles: a cell that could do with a coarser one takes
  // the finer one if another cell asks for that anyhow.
  void cover() {
    find_windows();
    choose_levels();
    if (demand_.is_too_much(chosen_)) {
      demand_.lengthen_narrow_texels();
      for (const Choice& choice : choices_) {
        if (choice.use != kUnseen) out_.uses[choice.use].chosen = false;
      }
      choose_levels();
    }
    out_.draws.reserve(input_.patches.size());
    out_.cells.reserve(choices_.size());
    const Choice* choice = choices_.data();
    for (std::size_t k = 0; k < input_.patches.size(); ++k) {
      cover(input_.patches[k], *windows_[k], choice);
      choice += windows_[k]->cells.size();
    }
  }

 private:
  static constexpr std::uint32_t kUnseen = ~0U;  ///< the cell is out of view
  /// The tile that a cell would take by itself.
  struct Choice {
    std::uint32_t use = kUnseen;
    int spare = 0;  ///< levels coarser than the window
  };

  void find_windows() {
    std::size_t cells = 0;
    windows_.reserve(input_.patches.size());
    for (const SelectedPatch& patch : input_.patches) {
      windows_.push_back(&input_.growth.window(*patch.node, patch.tile_level, patch.squeeze));
      cells += windows_.back()->cells.size();
    }
    choices_.resize(cells);
  }

  void choose_levels() {
    Choice* choice = choices_.data();
    for (std::size_t k = 0; k < input_.patches.size(); ++k)
      choice = choose_levels(input_.patches[k], *windows_[k], choice);
  }

  Choice* choose_levels(const SelectedPatch& patch, const TileWindow& win, Choice* choice) {
    const TileId last = last_tile(win.level);
    const double most_texels = TexelDemand::coarse_enough(win.level);
    for (int y = 0; y < win.h; ++y) {
      for (int x = 0; x < win.w; ++x, ++choice) {
        *choice = {};
        if (!cells_.sees(patch, win, x, y, input_.growth)) continue;
        const TileId id = tile_of(win, x, y, last);
        choice->spare = demand_.levels_to_spare(id, win.cell(x, y), most_texels);
        choice->use = memo_.judged(coarser(id, choice->spare), patch.squeezed || choice->spare > 0);
        TileUse& use = out_.uses[choice->use];
        if (!use.chosen) ++chosen_;
        use.chosen = true;
      }
    }
    return choice;
  }

  void cover(const SelectedPatch& patch, const TileWindow& win, const Choice* choice) {
    const Margin beside = margin(patch, win);
    out_.draws.push_back(describe(*patch.node, win, beside, static_cast<std::uint32_t>(out_.cells.size())));
    const TileId last = last_tile(win.level);
    bool uncovered = false;
    for (int y = -beside.north; y < win.h + beside.south; ++y) {
      for (int x = -beside.west; x < win.w + beside.east; ++x) {
        const bool inside = x >= 0 && x < win.w && y >= 0 && y < win.h;
        const Found found = inside ? find(patch, tile_of(win, x, y, last), *choice++)
                                   : find_unseen(patch, tile_of(win, x, y, last), win.squeeze);
        uncovered = uncovered || found.uncovered;
        out_.cells.push_back(window_cell(found.slot, found.levels_up, found.levels_up + found.squeeze - win.squeeze));
      }
    }
    if (uncovered) ++out_.uncovered;
  }

  /// Cells added to a window on its sides.
  struct Margin {
    int west = 0, east = 0, north = 0, south = 0;
  };
  [[nodiscard]] Margin margin(const SelectedPatch& patch, const TileWindow& win) const {
    if (input_.shadow) return shadow_margin(*input_.shadow, *patch.node, win);
    if (!input_.columns_beside || !patch.in_band) return {};
    const int columns = std::min(win.w, spare_columns(win));
    return {.west = columns, .east = columns};
  }

  // Columns that a window has room for on either side: half of the circle in all, and none in a part of the planet.
  [[nodiscard]] int spare_columns(const TileWindow& win) const {
    const std::int64_t all = columns(grid_, win.level);
    if (static_cast<double>(all) * tile_span_deg(grid_, win.level) != 360.0) return 0;
    return static_cast<int>(std::max<std::int64_t>(((all >> win.squeeze) - win.w) / 2, 0));
  }

  // The shadow of a layer falls as far from it as the layer lies from the shadow, towards the Sun.
  [[nodiscard]] Margin shadow_margin(const ShadowCast& shadow, const PatchNode& node, const TileWindow& win) const {
    const double sine = glm::dot(node.normal, shadow.sun);
    const double lowest = std::sin(std::asin(std::clamp(sine, -1.0, 1.0)) - std::acos(node.cos_cone));
    const double up = std::max(lowest, kLongestShadow), height = shadow.height_m / input_.tree.ellipsoid().b_m();
    const double reach_rad = std::sqrt(up * up + height * (2.0 + height)) - up;
    const double cells = reach_rad * (180.0 / std::numbers::pi) / tile_span_deg(grid_, win.level);
    const double narrow = std::max(std::sin(node.min_colatitude_rad), 0.01);
    const auto most = [](double n, std::int64_t room) {
      return static_cast<int>(
          std::min({std::ceil(n), kMostBeside, static_cast<double>(std::max<std::int64_t>(room, 0))}));
    };
    const std::int64_t last_row = rows(grid_, win.level) - 1;
    const int columns = most(std::ldexp(cells / narrow, -win.squeeze), spare_columns(win));
    return {columns, columns, most(cells, win.y0), most(cells, last_row + 1 - win.y0 - win.h)};
  }

  [[nodiscard]] TileId last_tile(int level) {
    std::optional<TileId>& last = last_[static_cast<std::size_t>(level)];
    if (!last) last = TileId{level, columns(grid_, level) - 1, rows(grid_, level) - 1};
    return *last;
  }

  // Cells beyond the planet repeat its edge. Columns beside a window go round the planet.
  static TileId tile_of(const TileWindow& win, int x, int y, const TileId& last) {
    const std::int64_t column = (win.x0 + x) << win.squeeze;
    const std::int64_t round = x < 0 || x >= win.w ? (column + last.x + 1) % (last.x + 1) : column;
    return {win.level, std::min(round, last.x), std::min(win.y0 + y, last.y)};
  }

  static TileId coarser(const TileId& id, int levels) { return {id.level - levels, id.x >> levels, id.y >> levels}; }

  struct Found {
    int levels_up = 0;
    int squeeze = 0;
    int slot = 0;
    bool uncovered = false;
  };

  // A cell out of view takes a tile that is loaded; its own tile is neither requested nor counted.
  // Beside a window rows may be squeezed less than the window. A cell there takes a coarser tile, as wide as itself.
  Found find_unseen(const SelectedPatch& patch, const TileId& id, int squeeze) {
    for (int up = 0;; ++up) {
      TileUse& use = out_.uses[memo_.find(coarser(id, up), patch.squeezed || up > 0)];
      if (use.state == TileState::resident && up + use.id.squeeze >= squeeze) return drawn(use, up);
      if (id.level - up <= grid_.min_level) return {up, use.id.squeeze, 0, false};
    }
  }

  Found find(const SelectedPatch& patch, const TileId& id, const Choice& choice) {
    if (choice.use == kUnseen) return find_unseen(patch, id, 0);
    for (int up = 0; up < choice.spare; ++up) {
      const std::uint32_t use = memo_.find(coarser(id, up), patch.squeezed || up > 0);
      if (out_.uses[use].chosen) return find_seen(patch, id, up, use);
    }
    return find_seen(patch, id, choice.spare, choice.use);
  }

  // Climbs from a tile `up` levels coarser than the cell's.
  Found find_seen(const SelectedPatch& patch, const TileId& id, int up, std::uint32_t index) {
    bool counted = false;
    bool in_bounds = true;
    bool asked = false;  // one tile is asked for: the finest that can still come
    for (;; index = memo_.judged(coarser(id, ++up), true)) {
      TileUse& use = out_.uses[index];
      if (use.state == TileState::outside && input_.out_of_bounds == OutOfBounds::nothing) {
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
      if (id.level - up <= grid_.min_level) return {up, use.id.squeeze, 0, true};
    }
  }

  [[nodiscard]] static Found drawn(TileUse& use, int levels_up) {
    use.drawn = true;
    return {levels_up, use.id.squeeze, use.slot, false};
  }

  void want(const SelectedPatch& patch, TileUse& use) {
    if (use.wanted) return;
    use.wanted = true;
    const BoundingSphere& sphere = patch.body().sphere;
    const double depth = std::max(1.0, glm::dot(sphere.center_m - input_.view.eye.xyz_m, input_.view.forward));
    out_.wanted.push_back({use.id, -use.id.level + sphere.radius_m / (depth + sphere.radius_m)});
  }

  void count(TileUse& use) {
    if (use.counted) return;
    use.counted = true;
    ++out_.tiles;
    if (use.state == TileState::unknown) ++out_.pending;
    if (use.state == TileState::missing) ++out_.missing;
  }

  [[nodiscard]] PatchDraw describe(const PatchNode& node, const TileWindow& win, const Margin& beside,
                                   std::uint32_t first) const {
    const std::int64_t x0 = win.x0 - beside.west, y0 = win.y0 - beside.north;
    const auto width = static_cast<std::uint32_t>(win.w + beside.west + beside.east);
    const auto height = static_cast<std::uint32_t>(win.h + beside.north + beside.south);
    const double row = node.row_center_deg;
    const TileXY center = tile_xy(grid_, win.level, row, node.lon_center_deg);
    const double per_deg = 1.0 / tile_span_deg(grid_, win.level);
    PatchDraw draw;
    draw.center_and_scale = glm::vec4(std::ldexp(center.x, -win.squeeze) - static_cast<double>(x0),
                                      center.y - static_cast<double>(y0), std::ldexp(per_deg, -win.squeeze), per_deg);
    draw.frame = glm::vec4(node.frame);
    draw.row = glm::vec4(row, static_cast<double>(grid_.max_level - win.level), 0.0, 0.0);
    const auto low = [](std::int64_t n) { return static_cast<std::uint32_t>(n & 0xFFFFFF); };
    draw.window = glm::uvec4(first, width | height << 16U, low(x0), low(y0));
    return draw;
  }

  const CoverInput& input_;
  const TileGrid& grid_;
  UseMemo memo_;
  TileCoverage& out_;
  CellView cells_;
  TexelDemand demand_;
  std::vector<const TileWindow*> windows_;                     ///< window of each patch, in order
  std::vector<Choice> choices_;                                ///< choices for all cells, in order
  int chosen_ = 0;                                             ///< tiles that cells would take by themselves
  std::array<std::optional<TileId>, kMaxTileLevel + 1> last_;  ///< last tile of each level, once the level is needed
};

}  // namespace

void cover_with_tiles(const CoverInput& input, TileCoverage& out) {
  out.draws.clear();
  out.cells.clear();
  out.wanted.clear();
  out.uses.clear();
  out.tiles = out.pending = out.missing = out.uncovered = 0;
  out.shown = false;
  Coverer(input, out).cover();
}

}  // namespace terrella
