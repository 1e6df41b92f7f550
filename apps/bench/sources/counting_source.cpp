#include "apps/bench/sources/counting_source.h"

namespace terrella::bench {

Result<EncodedTile, TileFailure> CountingSource::read(const TileId& id) {
  Result<EncodedTile, TileFailure> tile = tiles_->read(id);
  ++requests_;
  if (tile) bytes_ += static_cast<std::int64_t>(tile->bytes.size());
  return tile;
}

}  // namespace terrella::bench
