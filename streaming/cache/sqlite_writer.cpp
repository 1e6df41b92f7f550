#include "streaming/cache/sqlite_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "streaming/file_bytes.h"

namespace terrella {
namespace {

/// Waits from this length on are reported to the user.
constexpr std::chrono::seconds kLongWait{1};
/// A constantly busy writer frees the lock only for moments, several hundred times a second. Short intervals find such
/// a moment; SQLite's own pauses of up to 100 ms may not.
constexpr std::chrono::microseconds kBetweenLooks{700};

int on_busy(void* context, int tried) {
  auto& patience = *static_cast<LockPatience*>(context);
  const auto now = std::chrono::steady_clock::now();
  if (tried == 0) patience.since = now;
  if (now - patience.since >= patience.limit) return 0;
  if (now - patience.since >= kLongWait && !patience.long_wait.exchange(true) && patience.on_long_wait) {
    patience.on_long_wait();
  }
  std::this_thread::sleep_for(kBetweenLooks);
  return 1;
}

WriteError error_of(sqlite3* database, int code, int system_error) {
  const bool full =
      code == SQLITE_FULL ||
      (code == SQLITE_IOERR && (system_error == ENOSPC || system_error == EFBIG || system_error == EDQUOT));
  if (full) return {WriteProblem::full, write_failure(system_error == 0 ? ENOSPC : system_error)};
  if (code == SQLITE_IOERR && system_error != 0) return {WriteProblem::other, std::strerror(system_error)};
  const std::string words = database == nullptr ? "out of memory" : sqlite3_errmsg(database);
  switch (code) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return {WriteProblem::busy, "another program holds the file"};
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return {WriteProblem::damaged, words};
    default:
      return {WriteProblem::other, words};
  }
}

int distrust(sqlite3* database) {
  sqlite3_extended_result_codes(database, 0);
  sqlite3_limit(database, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  // Debian's SQLite overwrites deleted data with zeros unless this is switched off.
  return sqlite3_exec(database,
                      "PRAGMA cell_size_check=ON; PRAGMA mmap_size=0; PRAGMA temp_store=MEMORY; "
                      "PRAGMA secure_delete=OFF; PRAGMA synchronous=NORMAL; PRAGMA wal_autocheckpoint=0; "
                      "PRAGMA cache_size=-8192",
                      nullptr, nullptr, nullptr);
}

}  // namespace

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
void SqliteWriter::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

void SqliteStatement::bind(int index, std::int64_t value) { sqlite3_bind_int64(statement_.get(), index, value); }

void SqliteStatement::bind(int index, const std::optional<std::int64_t>& value) {
  if (value) {
    bind(index, *value);
  } else {
    sqlite3_bind_null(statement_.get(), index);
  }
}

void SqliteStatement::bind(int index, std::string_view value) {
  // A null pointer would bind NULL instead of an empty text.
  sqlite3_bind_text64(statement_.get(), index, value.empty() ? "" : value.data(), value.size(), SQLITE_STATIC,
                      SQLITE_UTF8);
}

void SqliteStatement::bind(int index, std::span<const std::byte> value) {
  if (value.empty()) {
    sqlite3_bind_zeroblob(statement_.get(), index, 0);
  } else {
    sqlite3_bind_blob64(statement_.get(), index, value.data(), value.size(), SQLITE_STATIC);
  }
}

WriteResult<bool> SqliteStatement::step() {
  // sqlite3_system_errno() does not see failures in COMMIT.
  errno = 0;
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return error_of(sqlite3_db_handle(statement_.get()), code, errno);
}

WriteStatus SqliteStatement::run() {
  WriteResult<bool> more = step();
  while (more && *more) more = step();
  reset();
  if (!more) return more.error();
  return Done{};
}

void SqliteStatement::reset() { sqlite3_reset(statement_.get()); }

std::int64_t SqliteStatement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

bool SqliteStatement::is_null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }

std::string SqliteStatement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  if (text == nullptr) return {};
  return {text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

WriteResult<SqliteWriter> SqliteWriter::open(const std::filesystem::path& path, Mode mode,
                                             std::function<void()> on_long_wait) {
  SqliteWriter writer;
  sqlite3* database = nullptr;
  const int flags = (mode == Mode::read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE) | SQLITE_OPEN_NOMUTEX |
                    SQLITE_OPEN_PRIVATECACHE | (mode == Mode::create ? SQLITE_OPEN_CREATE : 0);
  errno = 0;
  const int opened = sqlite3_open_v2(path.c_str(), &database, flags, nullptr);
  writer.database_.reset(database);
  if (opened != SQLITE_OK) return error_of(database, opened, errno);
  writer.patience_ = std::make_unique<LockPatience>();
  writer.patience_->limit = kLockPatience;
  writer.patience_->on_long_wait = std::move(on_long_wait);
  sqlite3_busy_handler(database, on_busy, writer.patience_.get());
  errno = 0;
  if (const int code = distrust(database); code != SQLITE_OK) return error_of(database, code, errno);
  return writer;
}

WriteResult<SqliteWriter> SqliteWriter::make_private(const std::filesystem::path& path) {
  remove_database(path);
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return error_of(nullptr, SQLITE_IOERR, errno);
  close(file);
  WriteResult<SqliteWriter> made = open(path, Mode::existing);
  // SQLite counts the pages of the cache by the size that they have then.
  for (const char* pragma : {"PRAGMA page_size = 8192", "PRAGMA journal_mode = OFF", "PRAGMA synchronous = OFF",
                             "PRAGMA cache_size = -65536"}) {
    if (!made) break;
    if (WriteStatus done = made->run(pragma); !done) return done.error();
  }
  return made;
}

WriteResult<SqliteStatement> SqliteWriter::prepare(std::string_view sql) {
  sqlite3_stmt* statement = nullptr;
  errno = 0;
  const int code = sqlite3_prepare_v3(database_.get(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  if (code != SQLITE_OK) return error_of(database_.get(), code, errno);
  return SqliteStatement(statement);
}

WriteStatus SqliteWriter::run(std::string_view sql) { return run(SqlStatement{std::string(sql), {}}); }

WriteStatus SqliteWriter::run(const SqlStatement& said) {
  WriteResult<SqliteStatement> statement = prepare(said.sql);
  if (!statement) return statement.error();
  int parameter = 0;
  for (const std::string& text : said.texts) statement->bind(++parameter, std::string_view(text));
  for (const double number : said.numbers) sqlite3_bind_double(statement->statement_.get(), ++parameter, number);
  return statement->run();
}

WriteResult<std::int64_t> SqliteWriter::integer(std::string_view sql) {
  WriteResult<SqliteStatement> statement = prepare(sql);
  if (!statement) return statement.error();
  const WriteResult<bool> row = statement->step();
  if (!row) return row.error();
  return *row ? statement->integer(0) : 0;
}

WriteResult<std::string> SqliteWriter::text(std::string_view sql) {
  WriteResult<SqliteStatement> statement = prepare(sql);
  if (!statement) return statement.error();
  const WriteResult<bool> row = statement->step();
  if (!row) return row.error();
  return *row ? statement->text(0) : std::string();
}

std::int64_t SqliteWriter::changed_rows() const { return sqlite3_changes64(database_.get()); }
std::int64_t SqliteWriter::last_row_id() const { return sqlite3_last_insert_rowid(database_.get()); }
void SqliteWriter::wait_for_locks(std::chrono::milliseconds limit) { patience_->limit = limit; }

void SqliteWriter::leave_log_on_close(bool leave) {
  sqlite3_db_config(database_.get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, leave ? 1 : 0, nullptr);
}

void remove_database(const std::filesystem::path& path) {
  for (const char* ending : {"", "-journal", "-wal", "-shm"}) {
    std::error_code ignored;
    std::filesystem::remove(path.string() + ending, ignored);
  }
}

}  // namespace terrella
