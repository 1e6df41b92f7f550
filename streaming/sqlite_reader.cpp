#include "streaming/sqlite_reader.h"

#include <sqlite3.h>
#include <time.h>

#include <cmath>
#include <utility>

namespace terrella {
namespace {

constexpr int kStepsPerCheck = 1'000;
constexpr int kBusyTimeoutMs = 5'000;

void allow(RowAllowance& allowance, std::int64_t max_steps) {
  allowance = {.steps = max_steps, .until_s = thread_seconds() + kMaxRowSeconds};
}

int on_progress(void* context) {
  auto& allowance = *static_cast<RowAllowance*>(context);
  allowance.steps -= kStepsPerCheck;
  return allowance.steps < 0 || thread_seconds() > allowance.until_s ? 1 : 0;
}

SqlError sql_error(sqlite3* database, int code) {
  if (code == SQLITE_INTERRUPT)
    return {SqlProblem::too_long, "reading a row takes too long (no index, or a hostile view)"};
  const bool busy = code == SQLITE_BUSY || code == SQLITE_LOCKED;
  return {busy ? SqlProblem::busy : SqlProblem::broken,
          database != nullptr ? sqlite3_errmsg(database) : "out of memory"};
}

/// Secures a connection to an untrusted file: disables functions with side effects in its schema, and detects broken
/// pages.
int distrust(sqlite3* database, std::size_t max_value_bytes) {
  sqlite3_extended_result_codes(database, 0);
  sqlite3_busy_timeout(database, kBusyTimeoutMs);
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(max_value_bytes));
  sqlite3_limit(database, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  return sqlite3_exec(database, "PRAGMA cell_size_check=ON; PRAGMA mmap_size=0; PRAGMA temp_store=MEMORY", nullptr,
                      nullptr, nullptr);
}

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void SqliteQuery::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
void SqliteReader::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Result<SqliteReader, SqlError> SqliteReader::open(const std::filesystem::path& path, std::size_t max_value_bytes) {
  SqliteReader reader;
  sqlite3* database = nullptr;
  const int opened = sqlite3_open_v2(path.c_str(), &database,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_PRIVATECACHE, nullptr);
  reader.database_.reset(database);
  if (opened != SQLITE_OK) return sql_error(database, opened);
  reader.allowance_ = std::make_unique<RowAllowance>();
  allow(*reader.allowance_, kMaxRowSteps);
  sqlite3_progress_handler(database, kStepsPerCheck, on_progress, reader.allowance_.get());
  if (const int code = distrust(database, max_value_bytes); code != SQLITE_OK) return sql_error(database, code);
  return reader;
}

Result<SqliteQuery, SqlError> SqliteReader::prepare(const std::string& sql) {
  allow(*allowance_, kMaxRowSteps);
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(database_.get(), sql.c_str(), static_cast<int>(sql.size()), &statement, nullptr);
  if (code != SQLITE_OK) return sql_error(database_.get(), code);
  return SqliteQuery(statement, allowance_.get());
}

Result<bool, SqlError> SqliteReader::has_table(const std::string& name) {
  Result<SqliteQuery, SqlError> query =
      prepare("SELECT 1 FROM sqlite_master WHERE type IN ('table', 'view') AND lower(name) = lower(?1)");
  if (!query) return query.error();
  query->bind(1, name);
  return query->step();
}

Result<bool, SqlError> SqliteQuery::step(std::int64_t max_steps) {
  allow(*allowance_, max_steps);
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return sql_error(sqlite3_db_handle(statement_.get()), code);
}

void SqliteQuery::reset() {
  sqlite3_reset(statement_.get());
  sqlite3_clear_bindings(statement_.get());
}

void SqliteQuery::bind(int index, std::int64_t value) { sqlite3_bind_int64(statement_.get(), index, value); }

void SqliteQuery::bind(int index, const std::string& value) {
  sqlite3_bind_text(statement_.get(), index, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
}

std::optional<std::int64_t> SqliteQuery::integer(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_INTEGER) return std::nullopt;
  return sqlite3_column_int64(statement_.get(), column);
}

std::optional<double> SqliteQuery::number(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  if (type != SQLITE_INTEGER && type != SQLITE_FLOAT) return std::nullopt;
  const double value = sqlite3_column_double(statement_.get(), column);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<std::string> SqliteQuery::text(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_TEXT) return std::nullopt;
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  if (text == nullptr) return std::nullopt;
  return std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)));
}

std::optional<std::span<const std::byte>> SqliteQuery::blob(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_BLOB) return std::nullopt;
  const auto* bytes = static_cast<const std::byte*>(sqlite3_column_blob(statement_.get(), column));
  return std::span(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)));
}

std::string quote_identifier(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + "\"";
}

}  // namespace terrella
