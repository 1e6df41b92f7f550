#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace terrella {

/// Limits on the work for one row. The schema of a file decides what a query does, and a hostile view never ends. The
/// limits count steps of SQLite's virtual machine (one or two seconds of them) and processor time, because a single
/// step may be slow.
inline constexpr std::int64_t kMaxRowSteps = 20'000'000;
inline constexpr double kMaxRowSeconds = 2.0;

enum class SqlProblem {
  busy,      ///< another process holds the file; worth a retry
  too_long,  ///< one row exceeded its limits
  broken,    ///< anything else
};
struct SqlError {
  SqlProblem problem = SqlProblem::broken;
  std::string message;  ///< SQLite's text, without the path
};

/// Processor time of the calling thread in seconds. Wall time would make an honest file look slow on a busy machine.
[[nodiscard]] double thread_seconds();

/// Remaining work allowed for the current row.
struct RowAllowance {
  std::int64_t steps = 0;
  double until_s = 0.0;  ///< in processor time of the thread
};

/// A prepared query. Columns are read strictly: a value of another type is nullopt. Memory returned by text() and
/// blob() is valid until the next step() or reset(). thread: the connection's
class SqliteQuery {
 public:
  /// Returns true if there is a row, false at the end.
  [[nodiscard]] Result<bool, SqlError> step(std::int64_t max_steps = kMaxRowSteps);
  void reset();
  /// `index` starts at 1.
  void bind(int index, std::int64_t value);
  void bind(int index, const std::string& value);

  [[nodiscard]] std::optional<std::int64_t> integer(int column) const;
  [[nodiscard]] std::optional<double> number(int column) const;  ///< an INTEGER or REAL that is finite
  [[nodiscard]] std::optional<std::string> text(int column) const;
  [[nodiscard]] std::optional<std::span<const std::byte>> blob(int column) const;

 private:
  friend class SqliteReader;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  SqliteQuery(sqlite3_stmt* statement, RowAllowance* allowance) : statement_(statement), allowance_(allowance) {}
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  RowAllowance* allowance_;
};

/// A read-only connection to an untrusted database. Queries must not outlive the connection. thread: one at a time
class SqliteReader {
 public:
  /// A value over `max_value_bytes` makes its query fail. The error does not contain the path.
  [[nodiscard]] static Result<SqliteReader, SqlError> open(const std::filesystem::path& path,
                                                           std::size_t max_value_bytes);

  [[nodiscard]] Result<SqliteQuery, SqlError> prepare(const std::string& sql);
  /// True if a table or view has this name.
  [[nodiscard]] Result<bool, SqlError> has_table(const std::string& name);

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<RowAllowance> allowance_;  ///< on the heap, because SQLite keeps its address
  std::unique_ptr<sqlite3, Close> database_;
};

/// Quotes a name as an SQL identifier.
[[nodiscard]] std::string quote_identifier(const std::string& name);

}  // namespace terrella
