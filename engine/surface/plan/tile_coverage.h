#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "surface/plan/tile_uses.h"
#include "surface/selected_patch.h"
#include "surface/tree_growth.h"
#include "surface/wanted_tile.h"

namespace terrella {

/// One cell of a window on the GPU, 32 bits so that a fragment fetches one word. Bits 0 to 15 are the slot, whose lower
/// 12 bits are its array layer. Bits 16 to 23 are the number of cells that the cell's tile spans along a meridian, as a
/// power of two; bits 24 to 31 the same along the parallel. The low bits of the cell's column and row tell the cell's
/// part of that tile (shaders/surface/patch_common.glsl).
using WindowCell = std::uint32_t;
[[nodiscard]] constexpr WindowCell window_cell(int slot, int log2_rows, int log2_columns) {
  return static_cast<WindowCell>(slot) | static_cast<WindowCell>(log2_rows) << 16U |
         static_cast<WindowCell>(log2_columns) << 24U;
}

/// Data of a patch for the shader programs, besides its vertices.
struct PatchDraw {
  glm::vec4 center_and_scale;  ///< window point of the patch's centre; cells per degree of longitude and (south) of row
                               ///< latitude. Window points count cells from the window's north-west corner
  glm::vec4 frame;             ///< PatchNode::frame
  glm::vec4 row;      ///< row latitude of the centre, degrees; levels between the window's and the finest; unused
  glm::uvec4 window;  ///< first cell; width | height << 16; column and row of that first cell, modulo 2^24
  bool operator==(const PatchDraw&) const = default;
};

struct TileCoverage {
  std::vector<PatchDraw> draws;  ///< one for each selected patch
  std::vector<WindowCell> cells;
  std::vector<WantedTile> wanted;  ///< not there and not missing; root tiles first
  TileUses uses;                   ///< uses of the residency's tiles
  int tiles = 0;                   ///< tiles of the view at full quality
  int pending = 0;                 ///< those among `tiles` that are not loaded yet
  int missing = 0;                 ///< those among `tiles` that an ancestor replaces for good
  int uncovered = 0;               ///< patches with a cell in view for which not even an ancestor is there
  bool shown = false;              ///< a cell in view, within the grid's bounds, has a tile
  bool operator==(const TileCoverage&) const = default;
};

/// The cells of a draw of a coverage.
[[nodiscard]] inline std::span<const WindowCell> cells_of(const TileCoverage& coverage, std::size_t draw) {
  const glm::uvec4& window = coverage.draws[draw].window;
  return std::span(coverage.cells).subspan(window.x, std::size_t{window.y & 0xFFFFU} * (window.y >> 16U));
}
/// False for a cell without a tile.
[[nodiscard]] inline bool has_tile(WindowCell cell) { return (cell & 0xFFFFU) != 0; }

/// A layer at a height, metres over the ground, throws a shadow under this Sun: unit vector, ECEF.
struct ShadowCast {
  double height_m = 0.0;
  glm::dvec3 sun{0.0};
};
/// Sine of the Sun's height under which shadows grow no longer (shaders/surface/patch.vert).
inline constexpr double kLongestShadow = 0.05;

/// Fallback of a cell outside the bounds of the grid.
enum class OutOfBounds { ancestor, nothing };

struct CoverInput {
  const PatchTree& tree;
  TreeGrowth& growth;  ///< growth of that tree
  const View& view;
  const std::vector<SelectedPatch>& patches;
  const TileResidency& residency;
  double texels_per_pixel = 1.0;  ///< as PatchSelectionOptions has it
  OutOfBounds out_of_bounds = OutOfBounds::ancestor;
  bool has_relief = false;  ///< patches have heights
  /// Windows of patches in a pole band get cells on both sides, of tiles that are loaded anyhow: at the limb their
  /// pixels reach far over the patch.
  bool columns_beside = false;
  /// The layer's shadow on the ground; none: it has none. Windows get cells as far as it reaches, of tiles that are
  /// loaded anyhow.
  std::optional<ShadowCast> shadow = {};
};

/// Names a tile for every cell of every selected patch: the tile itself if it is resident, else its nearest resident
/// ancestor, else nothing (slot 0, which is a plain colour). Lists the tiles that are worth loading. Changes no tile:
/// TileUses::note() does. Windows that the tree does not have are made in the growth. Longitude wraps; cells beyond the
/// planet repeat its edge. A cell that asks for less than its patch takes a coarser tile. A view may want far more
/// texels of a full grid than it has pixels. Cells away from the equator then take tiles whose texels are a little
/// longer than a pixel. thread: any
void cover_with_tiles(const CoverInput& input, TileCoverage& out);

}  // namespace terrella
