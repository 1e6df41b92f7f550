#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "streaming/sqlite_reader.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Step limit for one tile. With an index a tile is found in dozens of steps; without one, this limit allows a scan of
/// a few hundred thousand rows.
inline constexpr std::int64_t kMaxTileSteps = 2'000'000;

/// Position of a tile in a table of tiles.
struct SqlitePlace {
  std::int64_t zoom = 0;
  std::int64_t column = 0;
  std::int64_t row = 0;
};

/// Gridded coverages have a scale and an offset for each tile (OGC 17-066r1, table 3).
enum class TileExtras { none, coverage };

/// Tiles of one table (zoom_level, tile_column, tile_row, tile_data) of a GeoPackage or an MBTiles file. Several
/// threads may read at once, each on its own connection. thread: any
class SqliteTiles {
 public:
  [[nodiscard]] static Result<std::unique_ptr<SqliteTiles>, SqlError> open(std::filesystem::path path,
                                                                           std::string table,
                                                                           TileExtras extras = TileExtras::none);

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const SqlitePlace& place);
  [[nodiscard]] std::optional<std::int64_t> count(std::int64_t zoom);
  /// Calls `call` with the column and row of each tile of a level, until `call` returns false. Returns true if all
  /// tiles were visited.
  [[nodiscard]] Result<bool, SqlError> for_each(std::int64_t zoom,
                                                const std::function<bool(std::int64_t, std::int64_t)>& call) const;

 private:
  /// A connection and its two queries, used by one thread at a time.
  struct Connection {
    SqliteReader reader;
    SqliteQuery tile;
    SqliteQuery count;
  };

  SqliteTiles(std::filesystem::path path, std::string table, TileExtras extras)
      : path_(std::move(path)), table_(std::move(table)), extras_(extras) {}
  [[nodiscard]] Result<Connection, SqlError> connect() const;
  [[nodiscard]] Result<Connection, SqlError> take();
  void give_back(Connection connection);
  [[nodiscard]] TileFailure failure_of(const SqlError& error);

  const std::filesystem::path path_;
  const std::string table_;
  const TileExtras extras_;
  std::atomic<bool> given_up_ = false;
  std::mutex mutex_;
  std::vector<Connection> idle_;  ///< as many as there were readers at once; guarded by mutex_
};

}  // namespace terrella
