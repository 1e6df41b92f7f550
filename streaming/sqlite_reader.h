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

/// How long one row may take: the file's schema decides what a query does, and a hostile view never ends. In steps of
/// SQLite's virtual machine, a second or two of them, and in processor time, since a step may be a slow one.
inline constexpr std::int64_t kMaxRowSteps = 20'000'000;
inline constexpr double kMaxRowSeconds = 2.0;

enum class SqlProblem {
  busy,      ///< another process holds the file; may be asked again
  too_long,  ///< one row took more than it may
  broken,    ///< anything else
};
struct SqlError {
  SqlProblem problem = SqlProblem::broken;
  std::string message;  ///< SQLite's words, without the path
};

/// The calling thread's processor time: a busy machine must not make an honest file slow.
[[nodiscard]] double thread_seconds();

/// What is left of a row's allowance.
struct RowAllowance {
  std::int64_t steps = 0;
  double until_s = 0.0;  ///< by the thread's own processor time
};

/// One prepared query. Columns are read strictly: a value of another type than asked for is nullopt. What text() and
/// blob() point to lives until the next step() or reset(). thread: the connection's
class SqliteQuery {
 public:
  /// True: there is a row. False: there are no more.
  [[nodiscard]] Result<bool, SqlError> step(std::int64_t max_steps = kMaxRowSteps);
  void reset();
  /// `index` counts from 1.
  void bind(int index, std::int64_t value);
  void bind(int index, const std::string& value);

  [[nodiscard]] std::optional<std::int64_t> integer(int column) const;
  [[nodiscard]] std::optional<double> number(int column) const;  ///< INTEGER or REAL, finite
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

/// A read-only connection to a database that nobody vouches for. Queries must not outlive it. thread: one at a time
class SqliteReader {
 public:
  /// Values over `max_value_bytes` are errors of the query. The error does not name the path.
  [[nodiscard]] static Result<SqliteReader, SqlError> open(const std::filesystem::path& path,
                                                           std::size_t max_value_bytes);

  [[nodiscard]] Result<SqliteQuery, SqlError> prepare(const std::string& sql);
  /// A table or view of that name.
  [[nodiscard]] Result<bool, SqlError> has_table(const std::string& name);

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<RowAllowance> allowance_;  ///< on the heap: SQLite keeps its address
  std::unique_ptr<sqlite3, Close> database_;
};

/// A name in double quotes, as SQL takes it.
[[nodiscard]] std::string quote_identifier(const std::string& name);

}  // namespace terrella
