#pragma once

#include <cstdint>
#include <vector>

#include "codecs/image.h"
#include "tiles/tile_source.h"

// thread: any, for all of this header
namespace terrella {

inline constexpr int kMaxMips = 5;

/// A tile as a texture array takes it: mip levels, each with a border filled by clamping its edge. Mip k is
/// (tile_px >> k) + 2 · (gutter >> k) texels a side, RGBA8, rows from the top, no padding.
struct TileTexels {
  int tile_px = 0;
  int gutter = 0;                               ///< texels of border on each side of mip 0
  bool opaque = true;                           ///< every texel's alpha is 255
  std::vector<std::vector<std::uint8_t>> mips;  ///< finest first
};

[[nodiscard]] constexpr int mip_side_px(int tile_px, int gutter, int mip) {
  return (tile_px >> mip) + 2 * (gutter >> mip);
}
[[nodiscard]] std::size_t size_bytes(const TileTexels& texels);

/// Mip k is the mean of 2^k × 2^k texels of the tile, colours weighed by alpha (what is invisible does not tint what is
/// not; no colour where all alpha is 0), each channel rounded once to nearest (halves up).
/// Where tile_px is no multiple of 2^k the last column and row are left out of the mean. `mips` counts mip 0 too: [1,
/// kMaxMips]; gutter ≥ 0; tile_px ≥ 2^(mips - 1). A tile of another size than tile_px is broken, and the reason names
/// both sizes. thread: any
[[nodiscard]] Result<TileTexels, TileFailure> make_texels(const Image& tile, int tile_px, int gutter, int mips);

/// Colours times alpha, rounded to nearest: what linear filtering and blending take. Once. thread: any
void premultiply(TileTexels& texels);

}  // namespace terrella
