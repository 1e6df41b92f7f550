#pragma once

#include <cstdint>
#include <vector>

#include "codecs/image.h"
#include "tiles/tile_source.h"

// thread: any, for all of this header
namespace terrella {

inline constexpr int kMaxMips = 5;

/// A tile in the layout of a texture array: mip levels, each with a border that repeats its edge texels. Mip k has
/// (tile_px >> k) + 2 · (gutter >> k) texels per side, RGBA8 or one number each, rows from the top, no
/// padding.
struct TileTexels {
  int tile_px = 0;
  int gutter = 0;                               ///< texels of border on each side of mip 0
  bool opaque = true;                           ///< true if every texel's alpha is 255, or has data
  std::vector<std::vector<std::uint8_t>> mips;  ///< finest first
};

[[nodiscard]] constexpr int mip_side_px(int tile_px, int gutter, int mip) {
  return (tile_px >> mip) + 2 * (gutter >> mip);
}
[[nodiscard]] std::size_t size_bytes(const TileTexels& texels);

/// Makes the mip levels of a tile. Mip k is the mean of 2^k × 2^k texels of the tile. Colours are weighted by alpha, so
/// that invisible texels do not tint visible ones; if all alpha is 0, the colour is 0. Each channel is rounded once to
/// nearest (halves up). If tile_px is not a multiple of 2^k, the last column and row are left out of the mean. `mips`
/// includes mip 0: [1, kMaxMips]; gutter ≥ 0; tile_px ≥ 2^(mips - 1). A tile of another size than tile_px is broken,
/// and the reason names both sizes. thread: any
[[nodiscard]] Result<TileTexels, TileFailure> make_texels(const Image& tile, int tile_px, int gutter, int mips);

/// Multiplies colours by alpha, rounded to nearest, for linear filtering and blending. Call this once per tile.
/// thread: any
void premultiply(TileTexels& texels);

}  // namespace terrella
