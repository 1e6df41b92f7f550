#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "streaming/cache/tile_cache.h"
#include "streaming/sqlite_reader.h"

namespace terrella {

/// A record as the file has it.
struct FoundRecord {
  CacheRecord record;
  std::optional<std::int64_t> row;   ///< of a tile
  std::optional<std::int64_t> used;  ///< none: pinned tile or absence
};

/// Looks tiles up, each reader on a connection of its own. thread: any, several at once
class CacheReaders {
 public:
  explicit CacheReaders(std::filesystem::path path) : path_(std::move(path)) {}

  /// Without `bytes` the record's bytes stay empty.
  [[nodiscard]] Result<std::optional<FoundRecord>> find(const TileId& id, bool bytes);
  /// Records without bytes of the rows [first_y, last_y] of a column, from the north.
  [[nodiscard]] Result<std::vector<std::pair<std::int64_t, FoundRecord>>> find_column(int level, std::int64_t x,
                                                                                      std::int64_t first_y,
                                                                                      std::int64_t last_y);
  void close();  ///< ends idle connections

 private:
  struct Connection {
    SqliteReader reader;
    SqliteQuery whole;  ///< with the tile's bytes
    SqliteQuery brief;
    SqliteQuery column;
  };
  [[nodiscard]] Result<Connection, SqlError> take();
  void give_back(Connection connection);

  const std::filesystem::path path_;
  std::mutex mutex_;
  std::vector<Connection> idle_;  ///< guarded by mutex_
};

}  // namespace terrella
