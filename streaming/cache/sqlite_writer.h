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
  busy,     ///< another process held the file for longer than one waits
  full,     ///< no space, or a limit on the file's size
  damaged,  ///< not a database, or pages that contradict each other
  other,
};
struct WriteError {
  WriteProblem problem = WriteProblem::other;
  std::string message;  ///< by the system's reason if there is one, else SQLite's words; without the path
};
template <class T>
using WriteResult = Result<T, WriteError>;
using WriteStatus = WriteResult<Done>;

/// A prepared statement. What is bound as a view must live until reset(). thread: the connection's
class SqliteStatement {
 public:
  void bind(int index, std::int64_t value);
  void bind(int index, const std::optional<std::int64_t>& value);  ///< none: NULL
  void bind(int index, std::string_view value);
  void bind(int index, std::span<const std::byte> value);
  /// True: there is a row. False: done.
  [[nodiscard]] WriteResult<bool> step();
  /// Runs it to its end and resets it.
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

/// How long to wait for a lock, and since when.
struct LockPatience {
  std::chrono::milliseconds limit{0};
  std::chrono::steady_clock::time_point since{};
  std::atomic<bool> long_wait = false;  ///< a wait has taken more than a second and goes on
  std::function<void()> on_long_wait{};
};

/// A connection that writes. The file's schema is distrusted: no triggers, no views, no functions with side effects.
/// Statements must not outlive it. thread: one at a time
class SqliteWriter {
 public:
  enum class Mode { read, existing, create };  ///< read: for checks that have no bounds; writes fail
  /// `on_long_wait` is called once for each wait for a lock of more than a second, by the thread that waits.
  [[nodiscard]] static WriteResult<SqliteWriter> open(const std::filesystem::path& path, Mode mode,
                                                      std::function<void()> on_long_wait = {});

  [[nodiscard]] WriteResult<SqliteStatement> prepare(std::string_view sql);
  [[nodiscard]] WriteStatus run(std::string_view sql);
  [[nodiscard]] WriteStatus run(const SqlStatement& said);
  /// The first column of the first row.
  [[nodiscard]] WriteResult<std::int64_t> integer(std::string_view sql);
  [[nodiscard]] WriteResult<std::string> text(std::string_view sql);

  [[nodiscard]] std::int64_t changed_rows() const;  ///< by the last INSERT, UPDATE or DELETE
  [[nodiscard]] std::int64_t last_row_id() const;

  /// How long a lock that another process holds is waited for; at first 60 s.
  void wait_for_locks(std::chrono::milliseconds limit);
  /// True while it waits for a lock, from the second second on, until end_wait_for_lock(). thread: any
  [[nodiscard]] bool waits_for_lock() const { return patience_->long_wait; }
  void end_wait_for_lock() { patience_->long_wait = false; }
  /// Whether the write-ahead log stays as it is when the last connection closes.
  void leave_log_on_close(bool leave);

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<LockPatience> patience_;  ///< on the heap: SQLite keeps its address
  std::unique_ptr<sqlite3, Close> database_;
};

/// Deletes a database that nobody has open, with the journal or log that SQLite may have left beside it. thread: any
void remove_database(const std::filesystem::path& path);

}  // namespace terrella
