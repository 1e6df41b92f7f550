#include "tiles/tile_loader.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "tiles/number_texels.h"
#include "tiles/tile_scheduler.h"

namespace terrella {
namespace {

Result<TileTexels, TileFailure> as_texture(const Image& image, int tile_px, const LoaderOptions& options) {
  Result<TileTexels, TileFailure> texels = make_texels(image, tile_px, options.gutter, options.mips);
  if (texels) premultiply(*texels);
  return texels;
}

Result<TileTexels, TileFailure> texels_of(const EncodedTile& tile, int tile_px, const LoaderOptions& options) {
  if (tile.make_picture) {
    const Result<Image, TileFailure> made = tile.make_picture();
    if (!made) return made.error();
    return as_texture(*made, tile_px, options);
  }
  // A tile of another size is always refused: a small one after decoding, with both sizes in the error, a huge one
  // before.
  DecodeLimits limits;
  limits.max_side_px = std::max(tile_px, 1024);
  const Result<Image> image = decode_image(tile.bytes, limits);
  if (!image) return TileFailure{MissingKind::broken, image.error().message};
  return as_texture(*image, tile_px, options);
}

}  // namespace

int decoder_threads(unsigned cores) { return static_cast<int>(std::clamp(cores, 2U, 8U)); }

template class Loader<TileTexels>;

TileLoader::TileLoader(std::shared_ptr<TileSource> source, const LoaderOptions& options)
    : Loader(start_scheduler<TileTexels>(source, options.workers, options.max_finished_bytes, options.bell,
                                         [tile_px = source->info().grid.tile_px, numbers = source->info().numbers,
                                          options](const TileId&, const EncodedTile& tile) {
                                           return numbers ? make_number_texels(tile, *numbers, tile_px, options.gutter,
                                                                               options.mips)
                                                          : texels_of(tile, tile_px, options);
                                         })) {
  assert(options.mips >= 1 && options.mips <= kMaxMips && options.gutter >= 0);
}

}  // namespace terrella
