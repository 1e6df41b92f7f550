#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "streaming/cache/sqlite_writer.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// The places of a set's tiles, sorted on the disk: level by level, the tiles of Web Mercator along Hilbert's curve,
/// those of other grids by rows. Each place is kept once. Memory does not grow with the number of places. thread: one
/// at a time
class TileOrder {
 public:
  /// Makes the file, and replaces an earlier one.
  [[nodiscard]] static WriteResult<TileOrder> make(const std::filesystem::path& path, const TileGrid& grid);

  /// The tile exists in the grid.
  [[nodiscard]] WriteStatus add(const TileId& id);
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// Calls `call` for each place until it returns false.
  [[nodiscard]] WriteStatus for_each(const std::function<bool(const TileId& id)>& call);

 private:
  TileOrder(SqliteWriter database, SqliteStatement insert, const TileGrid& grid);

  SqliteWriter database_;
  SqliteStatement insert_;
  int zoom_of_roots_ = 0;
  bool by_curve_ = false;
  std::int64_t count_ = 0;
};

}  // namespace terrella
