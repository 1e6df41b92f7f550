#include "scene/tile_coverage.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace terrella {
namespace {

class Coverer {
 public:
  Coverer(PatchTree& tree, const View& view, TileResidency& residency, std::uint64_t frame, TileCoverage& out)
      : tree_(tree), view_(view), residency_(residency), frame_(frame), out_(out), planes_(view_planes(view)) {
    const Ellipsoid& e = tree.ellipsoid();
    axes_m_ = glm::dvec3(e.a_m(), e.a_m(), e.b_m());
    eye_scaled_ = view.eye.xyz_m / axes_m_;
    seen_from_outside_ = glm::dot(eye_scaled_, eye_scaled_) > 1.0;
  }

  void cover(const SelectedPatch& patch) {
    const TileWindow& win = tree_.window(*patch.node, patch.tile_level);
    out_.draws.push_back(describe(*patch.node, win, static_cast<std::uint32_t>(out_.cells.size())));
    bool uncovered = false;
    for (int y = 0; y < win.h; ++y) {
      for (int x = 0; x < win.w; ++x) {
        const Found found = find(patch, win, x, y);
        uncovered = uncovered || found.uncovered;
        out_.cells.push_back(window_cell(found.slot, found.levels_up));
      }
    }
    if (uncovered) ++out_.uncovered;
  }

  void want(const TileId& id, double priority) {
    TileResidency::Entry& entry = residency_.entry(id);
    if (entry.last_wanted == frame_ || entry.state != TileState::unknown) return;
    entry.last_wanted = frame_;
    out_.wanted.push_back({id, priority});
  }

 private:
  struct Found {
    int levels_up = 0;
    int slot = 0;
    TileId tile;
    bool uncovered = false;
  };

  static std::size_t index(const TileWindow& win, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(win.w) + static_cast<std::size_t>(x);
  }

  [[nodiscard]] bool in_view(const SelectedPatch& patch, const BoundingSphere& sphere) const {
    if (!patch.cut_by_view) return true;
    if (classify(planes_, view_, sphere) < 0) return false;
    if (!seen_from_outside_) return true;
    // Scaled by the shortest axis the sphere still holds what it held.
    return glm::dot(sphere.center_m / axes_m_, eye_scaled_) + glm::length(eye_scaled_) * sphere.radius_m / axes_m_.z >=
           1.0;
  }

  Found find(const SelectedPatch& patch, const TileWindow& win, int x, int y) {
    const TileGrid& grid = tree_.grid();
    TileId id{win.level, win.x0 + x, win.y0 + y};
    id.x = std::clamp<std::int64_t>(id.x, 0, columns(grid, win.level) - 1);
    id.y = std::clamp<std::int64_t>(id.y, 0, rows(grid, win.level) - 1);
    const bool visible = in_view(patch, win.cells[index(win, x, y)]);
    Found found{0, 0, id, false};
    bool counted = false;
    bool asked = false;  // one tile is asked for: the finest that can still come
    for (;; ++found.levels_up, found.tile = parent(found.tile)) {
      TileResidency::Entry& entry = residency_.entry(found.tile);
      if (entry.state == TileState::unknown && !exists(grid, found.tile)) entry.state = TileState::outside;
      if (visible && !counted && entry.state != TileState::outside) {
        counted = true;
        count(entry);
      }
      if (entry.state == TileState::resident) {
        entry.last_drawn = frame_;
        found.slot = entry.slot;
        return found;
      }
      if (visible && !asked && entry.state == TileState::unknown) {
        asked = true;
        const double depth = std::max(1.0, glm::dot(patch.node->sphere.center_m - view_.eye.xyz_m, view_.forward));
        want(found.tile, -found.tile.level + patch.node->sphere.radius_m / (depth + patch.node->sphere.radius_m));
      }
      if (found.tile.level <= grid.min_level) break;
    }
    found.uncovered = visible;
    found.slot = 0;
    return found;
  }

  void count(TileResidency::Entry& entry) {
    if (entry.last_counted == frame_) return;
    entry.last_counted = frame_;
    ++out_.tiles;
    if (entry.state == TileState::unknown) ++out_.missing;
    if (entry.state == TileState::lacking) ++out_.lacking;
  }

  [[nodiscard]] PatchDraw describe(const PatchNode& node, const TileWindow& win, std::uint32_t first) const {
    const TileGrid& grid = tree_.grid();
    const double row = row_latitude_deg(grid, tree_.ellipsoid(), EcefDir{node.normal});
    const TileXY center = tile_xy(grid, win.level, row, node.lon_center_deg);
    const double per_deg = 1.0 / tile_span_deg(grid, win.level);
    PatchDraw draw;
    draw.center_and_scale =
        glm::vec4(center.x - static_cast<double>(win.x0), center.y - static_cast<double>(win.y0), per_deg, per_deg);
    draw.frame = glm::vec4(node.frame);
    draw.row = glm::vec4(row, static_cast<double>(grid.max_level - win.level), 0.0, 0.0);
    const auto low = [](std::int64_t n) { return static_cast<std::uint32_t>(n & 0xFFFFFF); };
    draw.window = glm::uvec4(first, static_cast<std::uint32_t>(win.w) | static_cast<std::uint32_t>(win.h) << 16U,
                             low(win.x0), low(win.y0));
    return draw;
  }

  PatchTree& tree_;
  const View& view_;
  TileResidency& residency_;
  std::uint64_t frame_;
  TileCoverage& out_;
  ViewPlanes planes_;
  glm::dvec3 axes_m_{1.0};
  glm::dvec3 eye_scaled_{0.0};
  bool seen_from_outside_ = false;
};

}  // namespace

std::vector<TileId> root_tiles(const TileGrid& grid) {
  std::vector<TileId> tiles;
  for (std::int64_t y = 0; y < rows(grid, grid.min_level); ++y) {
    for (std::int64_t x = 0; x < columns(grid, grid.min_level); ++x) {
      const TileId id{grid.min_level, x, y};
      if (exists(grid, id)) tiles.push_back(id);
    }
  }
  return tiles;
}

void cover_with_tiles(PatchTree& tree, const View& view, const std::vector<SelectedPatch>& patches,
                      TileResidency& residency, std::uint64_t frame, TileCoverage& out) {
  out.draws.clear();
  out.cells.clear();
  out.wanted.clear();
  out.tiles = out.missing = out.lacking = out.uncovered = 0;
  Coverer coverer(tree, view, residency, frame, out);
  for (const SelectedPatch& patch : patches) coverer.cover(patch);
}

}  // namespace terrella
