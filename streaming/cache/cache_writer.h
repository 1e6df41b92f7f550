#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>

#include "streaming/cache/cache_limit.h"
#include "streaming/cache/cache_rows.h"
#include "streaming/cache/sqlite_writer.h"
#include "streaming/cache/write_queue.h"

namespace terrella {

/// Writes batches into a cache, keeps its size and its log within limits. thread: one at a time; the counts any
class CacheWriter {
 public:
  [[nodiscard]] static WriteResult<std::unique_ptr<CacheWriter>> make(SqliteWriter database, std::filesystem::path path,
                                                                      int root_level, std::uint64_t max_bytes);

  /// One transaction; on failure nothing of the batch is written. `no_room`, of the batch's size: set for tiles that
  /// are not written because the limit is reached and nothing is left that may be evicted.
  [[nodiscard]] Status write(const CacheBatch& batch, std::vector<bool>& no_room);
  /// After some idle time: gives space back and empties the log.
  void tidy();
  /// Leaves one plain file behind if nobody else has it open: no log, readable where nothing can be written.
  void close();

  [[nodiscard]] const CacheBudget& budget() const { return budget_; }
  [[nodiscard]] std::uint64_t stored() const { return stored_; }
  [[nodiscard]] std::uint64_t evicted() const { return evicted_; }
  [[nodiscard]] std::uint64_t pins_changed() const { return pins_changed_; }
  [[nodiscard]] bool locked() const { return database_.waits_for_lock(); }

 private:
  CacheWriter(SqliteWriter database, std::filesystem::path path)
      : database_(std::move(database)), path_(std::move(path)) {}
  [[nodiscard]] WriteStatus write_rows(const CacheBatch& batch, std::int64_t now_unix_s, std::vector<bool>& no_room);
  [[nodiscard]] WriteStatus write_row(const CacheChange& change, std::int64_t now_unix_s);
  /// Evicts until so many pages fit; false: they do not, and nothing is left that may be evicted.
  [[nodiscard]] WriteResult<bool> make_room(std::int64_t needed_pages);
  /// Pages by which the file would be over its limit with so many more.
  [[nodiscard]] WriteResult<std::int64_t> pages_too_many(std::int64_t needed_pages);
  /// A tile that is there gives its place to the new one.
  [[nodiscard]] WriteResult<bool> fits(const CacheChange& change);
  [[nodiscard]] WriteStatus give_back_pages();
  void keep_log_short();
  /// False if it could not be done to its end.
  bool checkpoint(const char* mode, std::chrono::milliseconds patience);

  SqliteWriter database_;
  const std::filesystem::path path_;
  CacheBudget budget_;
  std::int64_t page_bytes_ = 0;
  std::optional<CacheRows> rows_;
  std::optional<SqliteStatement> begin_, commit_, rollback_, page_count_, free_count_;
  std::atomic<std::uint64_t> stored_ = 0;
  std::atomic<std::uint64_t> evicted_ = 0;
  std::atomic<std::uint64_t> pins_changed_ = 0;
  std::uint64_t evicted_now_ = 0;  ///< in the transaction that is open
  std::uint64_t pins_now_ = 0;     ///< likewise
};

}  // namespace terrella
