#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "surface/patch_selection.h"
#include "tiles/tile_residency.h"

namespace terrella {

/// One cell of a window on the GPU, 32 bits so that a fragment fetches one word: the array layer in bits 0 to 15, how
/// many cells its tile spans along a meridian, as a power of two, in bits 16 to 23 and along the parallel in bits 24 to
/// 31. The low bits of the cell's column and row say which part of that tile it is (shaders/surface/patch_common.glsl).
using WindowCell = std::uint32_t;
[[nodiscard]] constexpr WindowCell window_cell(int layer, int log2_rows, int log2_columns) {
  return static_cast<WindowCell>(layer) | static_cast<WindowCell>(log2_rows) << 16U |
         static_cast<WindowCell>(log2_columns) << 24U;
}

/// Data of a patch for the shader programs, besides its vertices.
struct PatchDraw {
  glm::vec4 center_and_scale;  ///< window point of the patch's centre; cells per degree of longitude and (south) of row
                               ///< latitude. Window points count cells from the window's north-west corner
  glm::vec4 frame;             ///< PatchNode::frame
  glm::vec4 row;      ///< row latitude of the centre, degrees; levels between the window's and the finest; unused
  glm::uvec4 window;  ///< first cell; width | height << 16; column and row of that first cell, modulo 2^24
};

/// A tile that the view wants, with how much.
struct WantedTile {
  TileId id;
  double priority = 0.0;  ///< larger first: coarse before fine, then large on the screen
};

/// How a plan uses one tile of a layer.
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
};

/// The tiles that a plan uses, each once, in the order in which the plan came to them. thread: any, one at a time
class TileUses {
 public:
  void clear();
  /// Index of a tile's use. The residency tells its state when the plan comes to the tile for the first time.
  [[nodiscard]] std::uint32_t find(const TileId& id, const TileResidency& residency);
  [[nodiscard]] TileUse& operator[](std::uint32_t index) { return uses_[index]; }
  [[nodiscard]] const std::vector<TileUse>& all() const { return uses_; }

 private:
  static constexpr std::uint32_t kNone = ~0U;
  void grow();
  [[nodiscard]] std::size_t place(const TileId& id) const;

  std::vector<TileUse> uses_;
  std::vector<std::uint32_t> table_;  ///< indices by hash with linear probing; a power of two long, at most half full
};

struct TileCoverage {
  std::vector<PatchDraw> draws;  ///< one for each selected patch
  std::vector<WindowCell> cells;
  std::vector<WantedTile> wanted;  ///< not there and not missing; root tiles first
  TileUses uses;                   ///< of the residency's tiles
  int tiles = 0;                   ///< tiles of the view at full quality
  int pending = 0;                 ///< of those, not there yet
  int missing = 0;                 ///< of those, replaced by an ancestor for good
  int uncovered = 0;               ///< patches with a cell in view for which not even an ancestor is there
  bool shown = false;              ///< a cell in view, within the grid's bounds, has a tile
};

/// Fallback of a cell outside the bounds of the grid.
enum class OutOfBounds { ancestor, nothing };

struct CoverInput {
  const PatchTree& tree;
  TreeGrowth& growth;  ///< of that tree
  const View& view;
  const std::vector<SelectedPatch>& patches;
  const TileResidency& residency;
  double texels_per_pixel = 1.0;  ///< as PatchSelectionOptions has it
  OutOfBounds out_of_bounds = OutOfBounds::ancestor;
};

/// Names a tile for every cell of every selected patch: the tile itself if it is resident, else its nearest resident
/// ancestor, else nothing (slot 0, which is a plain colour). Lists what is worth loading. Changes no tile: note_use()
/// does. Windows missing from the tree are made in the growth. Longitude wraps; cells beyond the planet repeat its
/// edge. A cell that asks for less than its patch takes a coarser tile. Away from the equator a cell takes a tile whose
/// texels are a little longer than a pixel if the view would want far more texels of a full grid than it has pixels.
/// thread: any
void cover_with_tiles(const CoverInput& input, TileCoverage& out);

/// Tells the residency which tiles a frame uses: what it draws and needs is not evicted, what it saw not forgotten.
/// thread: main
void note_use(const TileUses& uses, std::uint64_t frame, TileResidency& residency);

/// The tiles of the coarsest level: always wanted, never evicted (engine/DESIGN.md, 10).
[[nodiscard]] std::vector<TileId> root_tiles(const TileGrid& grid);

}  // namespace terrella
