#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tiles/tile_residency.h"

namespace terrella {

/// Use of one tile of a layer by a plan.
struct TileUse {
  TileId id;
  TileState state = TileState::unknown;  ///< in the residency, or outside
  int slot = -1;                         ///< texture slot, if resident
  bool judged = false;                   ///< a cell in view took the tile into account
  bool chosen = false;                   ///< a cell would take the tile if all tiles were there
  bool counted = false;                  ///< in TileCoverage::tiles
  bool wanted = false;                   ///< in TileCoverage::wanted
  bool drawn = false;                    ///< a cell draws from the tile
  bool needed = false;                   ///< drawn where nothing finer can still come
  bool operator==(const TileUse&) const = default;
};

/// The tiles that a plan uses, each once, in the order in which the plan came to them. thread: any, one at a time
class TileUses {
 public:
  void clear();
  /// Index of a tile's use. The residency tells its state when the plan comes to the tile for the first time.
  [[nodiscard]] std::uint32_t find(const TileId& id, const TileResidency& residency);
  [[nodiscard]] TileUse& operator[](std::uint32_t index) { return uses_[index]; }
  [[nodiscard]] const std::vector<TileUse>& all() const { return uses_; }
  /// Tells the residency which tiles a frame uses: tiles drawn or needed are not evicted, tiles judged are not
  /// forgotten. Nothing may have been erased from the residency since the plan. thread: main
  void note(std::uint64_t frame, TileResidency& residency) const;

  [[nodiscard]] bool operator==(const TileUses& other) const { return uses_ == other.uses_; }

 private:
  static constexpr std::uint32_t kNone = ~0U;
  void grow();
  [[nodiscard]] std::size_t place(const TileId& id) const;

  std::vector<TileUse> uses_;
  std::vector<const TileResidency::Entry*> entries_;  ///< entries of the tiles in uses_; null: the tile had none
  std::vector<std::uint32_t> table_;  ///< indices by hash with linear probing; a power of two long, at most half full
};

/// Remembers uses that a plan looked up. Neighbouring cells climb through the same ancestors, so a few remembered uses
/// a level save most walks through the hash table.
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
    if (use.judged) return index;
    use.judged = true;
    if (use.state == TileState::unknown && !exists(grid_, use.id)) use.state = TileState::outside;
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

}  // namespace terrella
