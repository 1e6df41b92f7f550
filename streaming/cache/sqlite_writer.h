#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/sets/gpkg_schema.h"

struct sqlite3;
struct sqlite3_stmt;

namespace terrella {

enum class WriteProblem {
  busy,     ///< another process held the file for longer than the wait limit
  full,     ///< no space, or the limit on file size is reached
  damaged,  ///< not a database, or contradictory pages
  other,
};
struct WriteError {
  WriteProblem problem = WriteProblem::other;
  std::string message;  ///< the system's reason if there is one, else SQLite's text; without the path
};
template <class T>
using WriteResult = Result<T, WriteError>;
using WriteStatus = WriteResult<Done>;

/// A prepared statement. Memory bound as a view must stay valid until reset(). thread: the connection's
class SqliteStatement {
 public:
  void bind(int index, std::int64_t value);
  void bind(int index, const std::optional<std::int64_t>& value);  ///< none binds NULL
  void bind(int index, std::string_view value);
  void bind(int index, std::span<const std::byte> value);
  /// Returns true if there is a row, false at the end.
  [[nodiscard]] WriteResult<bool> step();
  /// Runs the statement to its end and resets it.
  [[nodiscard]] WriteStatus run();
  void reset();

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] bool is_null(int column) const;
  [[nodiscard]] std::string text(int column) const;

 private:
  friend class SqliteWriter;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  explicit SqliteStatement(sqlite3_stmt* statement) : statement_(statement) {}
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// Wait for a lock: its limit and its start.
struct LockPatience {
  std::chrono::milliseconds limit{0};
  std::chrono::steady_clock::time_point since{};
  std::atomic<bool> long_wait = false;  ///< the current wait has taken more than a second
  std::function<void()> on_long_wait{};
};

/// A writing connection. The schema of the file is untrusted: triggers, views and functions with side effects are
/// disabled. Statements must not outlive the connection. thread: one at a time
class SqliteWriter {
 public:
  enum class Mode { read, existing, create };  ///< read: for checks without work limits; writes fail
  /// `on_long_wait` is called once for each wait for a lock of more than a second, on the waiting thread.
  [[nodiscard]] static WriteResult<SqliteWriter> open(const std::filesystem::path& path, Mode mode,
                                                      std::function<void()> on_long_wait = {});

  /// Makes a file that no other process knows: without a journal, because a broken one is deleted, and with 64 MiB of
  /// pages in memory. Removes an existing file of that name.
  [[nodiscard]] static WriteResult<SqliteWriter> make_private(const std::filesystem::path& path);

  [[nodiscard]] WriteResult<SqliteStatement> prepare(std::string_view sql);
  [[nodiscard]] WriteStatus run(std::string_view sql);
  [[nodiscard]] WriteStatus run(const SqlStatement& said);
  /// Returns the first column of the first row.
  [[nodiscard]] WriteResult<std::int64_t> integer(std::string_view sql);
  [[nodiscard]] WriteResult<std::string> text(std::string_view sql);

  [[nodiscard]] std::int64_t changed_rows() const;  ///< rows changed by the last INSERT, UPDATE or DELETE
  [[nodiscard]] std::int64_t last_row_id() const;

  static constexpr std::chrono::milliseconds kLockPatience{60'000};
  /// Sets the longest wait for a lock of another process. The initial value is kLockPatience.
  void wait_for_locks(std::chrono::milliseconds limit);
  /// True during a wait for a lock, after its first second, until end_wait_for_lock(). thread: any
  [[nodiscard]] bool waits_for_lock() const { return patience_->long_wait; }
  void end_wait_for_lock() { patience_->long_wait = false; }
  /// If true, the write-ahead log stays when the last connection closes.
  void leave_log_on_close(bool leave);

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<LockPatience> patience_;  ///< on the heap, because SQLite keeps its address
  std::unique_ptr<sqlite3, Close> database_;
};

/// Deletes a database that is not open anywhere, with its journal or log. thread: any
void remove_database(const std::filesystem::path& path);

}  // namespace terrella
