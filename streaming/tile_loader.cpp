#include "streaming/tile_loader.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "streaming/tile_scheduler.h"

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
  // A tile of another size is refused in any case: a small one after decoding, by name of both sizes, a vast one
  // before.
  DecodeLimits limits;
  limits.max_side_px = std::max(tile_px, 1024);
  const Result<Image> image = decode_image(tile.bytes, limits);
  if (!image) return TileFailure{Absence::broken, image.error().message};
  return as_texture(*image, tile_px, options);
}

}  // namespace

struct TileLoader::Impl : TileScheduler<TileTexels> {
  using TileScheduler::TileScheduler;
};

TileLoader::TileLoader(std::shared_ptr<TileSource> source, const LoaderOptions& options) {
  assert(source != nullptr);
  assert(options.workers >= 1 && options.workers <= 64);
  assert(options.mips >= 1 && options.mips <= kMaxMips && options.gutter >= 0);
  const int tile_px = source->info().grid.tile_px;
  impl_ = std::make_shared<Impl>(
      std::move(source),
      [tile_px, options](const TileId&, const EncodedTile& tile) { return texels_of(tile, tile_px, options); },
      options.max_finished_bytes);
  impl_->start(options.workers);
}

TileLoader::~TileLoader() { impl_->stop(); }

void TileLoader::request(std::span<const TileRequest> wanted) { impl_->request(wanted); }

std::vector<LoadedTile> TileLoader::poll(std::size_t max_bytes) {
  std::vector<LoadedTile> loaded;
  for (auto& finished : impl_->poll(max_bytes)) loaded.push_back({finished.id, std::move(finished.tile)});
  return loaded;
}

bool TileLoader::wait(std::chrono::steady_clock::time_point deadline) { return impl_->wait(deadline); }

LoaderCounts TileLoader::counts() const { return impl_->counts(); }

}  // namespace terrella
