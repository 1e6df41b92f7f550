#include "scene/tile_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace terrella {
namespace {

// Entries looked up in this frame. Cells side by side climb through the same ancestors, so a few remembered entries a
// level save most walks through the hash table. Nothing is erased while a frame's cells are found.
class EntryMemo {
 public:
  explicit EntryMemo(TileResidency& residency) : residency_(residency) {}

  /// Nothing where no entry was ever made: then the tile is unknown.
  [[nodiscard]] TileResidency::Entry* find(const TileId& id) {
    Line& line = line_of(id);
    if (line.id != id) line = {id, residency_.find(id), false};
    return line.entry;
  }
  /// Made if it is not there; a tile that the grid does not have is told apart from one not asked for.
  [[nodiscard]] TileResidency::Entry& judged(const TileGrid& grid, const TileId& id) {
    Line& line = line_of(id);
    if (line.id == id && line.judged) return *line.entry;
    TileResidency::Entry& entry = residency_.entry(id);
    if (entry.state == TileState::unknown && !exists(grid, id)) entry.state = TileState::outside;
    line = {id, &entry, true};
    return entry;
  }

 private:
  struct Line {
    TileId id{-1, 0, 0};
    TileResidency::Entry* entry = nullptr;
    bool judged = false;
  };
  [[nodiscard]] Line& line_of(const TileId& id) {
    const std::int64_t place = (id.x & 3) | (id.y & 1) << 2;
    return lines_[static_cast<std::size_t>(id.level)][static_cast<std::size_t>(place)];
  }

  TileResidency& residency_;
  std::array<std::array<Line, 8>, kMaxTileLevel + 1> lines_;
};

class Coverer {
 public:
  Coverer(PatchTree& tree, const View& view, TileResidency& residency, std::uint64_t frame, TileCoverage& out)
      : tree_(tree), view_(view), memo_(residency), frame_(frame), out_(out), planes_(view_planes(view)) {
    const Ellipsoid& e = tree.ellipsoid();
    axes_m_ = glm::dvec3(e.a_m(), e.a_m(), e.b_m());
    eye_scaled_ = view.eye.xyz_m / axes_m_;
    eye_scaled_length_ = glm::length(eye_scaled_);
    seen_from_outside_ = glm::dot(eye_scaled_, eye_scaled_) > 1.0;
  }

  void cover(const SelectedPatch& patch) {
    const TileWindow& win = tree_.window(*patch.node, patch.tile_level);
    out_.draws.push_back(describe(*patch.node, win, static_cast<std::uint32_t>(out_.cells.size())));
    bool uncovered = false;
    const std::int64_t last_x = columns(tree_.grid(), win.level) - 1, last_y = rows(tree_.grid(), win.level) - 1;
    for (int y = 0; y < win.h; ++y) {
      for (int x = 0; x < win.w; ++x) {
        const TileId id{win.level, std::clamp<std::int64_t>(win.x0 + x, 0, last_x),
                        std::clamp<std::int64_t>(win.y0 + y, 0, last_y)};
        const Found found = in_view(patch, x, y) ? find_seen(patch, id) : find_unseen(id);
        uncovered = uncovered || found.uncovered;
        out_.cells.push_back(window_cell(found.slot, found.levels_up));
      }
    }
    if (uncovered) ++out_.uncovered;
  }

 private:
  struct Found {
    int levels_up = 0;
    int slot = 0;
    bool uncovered = false;
  };

  static std::size_t index(const TileWindow& win, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(win.w) + static_cast<std::size_t>(x);
  }

  // -1 out of view, 1 wholly in view, 0 perhaps in part.
  [[nodiscard]] int visible(const BoundingSphere& sphere) const {
    const int in_frame = classify(planes_, view_, sphere);
    if (in_frame < 0 || !seen_from_outside_) return in_frame;
    // Scaled by the shortest axis the sphere still holds what it held.
    const double over = glm::dot(sphere.center_m / axes_m_, eye_scaled_) - 1.0;
    const double reach = eye_scaled_length_ * sphere.radius_m / axes_m_.z;
    return over < -reach ? -1 : over < reach ? 0 : in_frame;
  }

  [[nodiscard]] bool in_view(const SelectedPatch& patch, int x, int y) {
    if (!patch.cut_by_view) return true;
    const int whole = visible(patch.node->window.cells[index(patch.node->window, x, y)].whole);
    if (whole != 0) return whole > 0;
    return std::ranges::any_of(tree_.cell_parts(*patch.node, x, y),
                               [this](const BoundingSphere& part) { return visible(part) >= 0; });
  }

  // A cell out of view takes what is there; nobody asks for its tile or counts it.
  Found find_unseen(TileId id) {
    for (int up = 0;; ++up, id = parent(id)) {
      TileResidency::Entry* entry = memo_.find(id);
      if (entry != nullptr && entry->state == TileState::resident) return drawn(*entry, up);
      if (id.level <= tree_.grid().min_level) return {up, 0, false};
    }
  }

  Found find_seen(const SelectedPatch& patch, TileId id) {
    const TileGrid& grid = tree_.grid();
    bool counted = false;
    bool asked = false;  // one tile is asked for: the finest that can still come
    for (int up = 0;; ++up, id = parent(id)) {
      TileResidency::Entry& entry = memo_.judged(grid, id);
      if (!counted && entry.state != TileState::outside) {
        counted = true;
        count(entry);
      }
      if (entry.state == TileState::resident) {
        if (!asked) entry.last_needed = frame_;
        return drawn(entry, up);
      }
      if (!asked && entry.state == TileState::unknown) {
        asked = true;
        want(patch, id, entry);
      }
      if (id.level <= grid.min_level) return {up, 0, true};
    }
  }

  [[nodiscard]] Found drawn(TileResidency::Entry& entry, int levels_up) const {
    entry.last_drawn = frame_;
    return {levels_up, entry.slot, false};
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
  EntryMemo memo_;
  std::uint64_t frame_;
  TileCoverage& out_;
  ViewPlanes planes_;
  glm::dvec3 axes_m_{1.0};
  glm::dvec3 eye_scaled_{0.0};
  double eye_scaled_length_ = 0.0;
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
