#include "tiles/height_loader.h"

#include "tiles/tile_scheduler.h"

namespace terrella {

template class Loader<HeightTile>;

HeightLoader::HeightLoader(const ElevationSource& source, const HeightLoaderOptions& options)
    : Loader(start_scheduler<HeightTile>(
          source.tiles(), options.workers, options.max_finished_bytes, options.bell,
          [source](const TileId& id, const EncodedTile& tile) { return source.decode(id, tile); })) {}

}  // namespace terrella
