#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "tiles/tile_source.h"

namespace terrella {

/// The tiles of another source under a description of its own. thread: as the other source
class PassedTiles : public TileSource {
 public:
  /// `tiles`: not null.
  PassedTiles(std::shared_ptr<TileSource> tiles, TileSetInfo info) : tiles_(std::move(tiles)), info_(std::move(info)) {}
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override { return tiles_->read(id); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read_or_stop(const TileId& id, const std::stop_token& stop) override {
    return tiles_->read_or_stop(id, stop);
  }
  [[nodiscard]] RemoteTiles* remote() override { return tiles_->remote(); }
  [[nodiscard]] std::uint64_t edition() const override { return tiles_->edition(); }
  [[nodiscard]] std::uint64_t edition_of(const TileId& id) const override { return tiles_->edition_of(id); }
  [[nodiscard]] std::optional<std::int64_t> count_tiles(int level) override { return tiles_->count_tiles(level); }
  [[nodiscard]] Result<double, TileFailure> value_at(const Geodetic& place, const Ellipsoid& figure) override {
    return tiles_->value_at(place, figure);
  }

 protected:
  [[nodiscard]] TileSource& tiles() const { return *tiles_; }

 private:
  std::shared_ptr<TileSource> tiles_;
  TileSetInfo info_;
};

}  // namespace terrella
