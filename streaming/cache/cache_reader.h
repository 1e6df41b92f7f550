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

/// A record as stored in the file.
struct FoundRecord {
  CacheRecord record;
  std::optional<std::int64_t> row;   ///< id of the tile's row
  std::optional<std::int64_t> used;  ///< time of last use; none: a pinned tile or a missing-tile record
};

/// Looks tiles up. Each lookup in progress has its own connection. thread: any, several at once
class CacheReaders {
 public:
  explicit CacheReaders(std::filesystem::path path) : path_(std::move(path)) {}

  /// If `bytes` is false, the record's bytes stay empty.
  [[nodiscard]] Result<std::optional<FoundRecord>> find(const TileId& id, bool bytes);
  /// Returns the records of the rows [first_y, last_y] of a column, from the north, without tile bytes.
  [[nodiscard]] Result<std::vector<std::pair<std::int64_t, FoundRecord>>> find_column(int level, std::int64_t x,
                                                                                      std::int64_t first_y,
                                                                                      std::int64_t last_y);
  void close();  ///< closes idle connections

 private:
  struct Connection {
    SqliteReader reader;
    SqliteQuery whole;  ///< returns the tile's bytes too
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
