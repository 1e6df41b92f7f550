#pragma once

#include <atomic>
#include <memory>

#include "tiles/tile_source.h"

namespace terrella::bench {

/// A tile set on disk that counts requests and bytes. thread: as TileSource
class CountingSource : public TileSource {
 public:
  explicit CountingSource(std::unique_ptr<TileSource> tiles) : tiles_(std::move(tiles)) {}

  [[nodiscard]] const TileSetInfo& info() const override { return tiles_->info(); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override;

  [[nodiscard]] std::int64_t requests() const { return requests_; }
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }  ///< as stored

 private:
  std::unique_ptr<TileSource> tiles_;
  std::atomic<std::int64_t> requests_ = 0, bytes_ = 0;
};

}  // namespace terrella::bench
