#include "streaming/cache/cache_report.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "streaming/cache/cache_schema.h"
#include "streaming/sets/directory_source.h"
#include "streaming/sets/geopackage_source.h"
#include "streaming/sets/tileset_json.h"
#include "streaming/sqlite_reader.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxProblems = 100;
/// A count visits all rows of a table, maybe hundreds of millions.
constexpr std::int64_t kCountSteps = std::numeric_limits<std::int64_t>::max();

/// Error for a truncated file, or one with random pages.
Error damaged(const fs::path& path, const SqlError& error) {
  return Error{fmt::format("{}: the cache is damaged or was cut off: {}; preload it again, or leave it out",
                           path.string(), error.message)};
}

/// Asks a chain of questions. Keeps the first error and then skips the remaining questions.
class Questions {
 public:
  explicit Questions(const fs::path& path) : path_(path) {
    Result<SqliteReader, SqlError> reader = SqliteReader::open(path, kMaxTileBytes);
    if (reader) {
      reader_ = *std::move(reader);
    } else {
      fail(reader.error());
    }
  }

  /// Calls `row` for each row until `row` returns false.
  template <class Row>
  void ask(const std::string& sql, const Row& row, std::optional<std::int64_t> parameter = {}) {
    if (error_) return;
    Result<SqliteQuery, SqlError> query = reader_->prepare(sql);
    if (!query) return fail(query.error());
    if (parameter) query->bind(1, *parameter);
    Result<bool, SqlError> more = query->step(kCountSteps);
    while (more && *more && row(*query)) more = query->step(kCountSteps);
    if (!more) fail(more.error());
  }

  std::string text(const std::string& sql) {
    std::string value;
    ask(sql, [&](const SqliteQuery& query) {
      value = query.text(0).value_or("");
      return false;
    });
    return value;
  }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  void fail(const SqlError& error) {
    error_ = error.problem == SqlProblem::broken
                 ? damaged(path_, error)
                 : Error{fmt::format("{}: the cache cannot be read: {}", path_.string(), error.message)};
  }

  const fs::path path_;
  std::optional<SqliteReader> reader_;
  std::optional<Error> error_;
};

std::uint64_t used_bytes(Questions& questions) {
  std::int64_t numbers[3] = {};
  const char* pragmas[] = {"PRAGMA page_count", "PRAGMA freelist_count", "PRAGMA page_size"};
  for (std::size_t i = 0; i < std::size(pragmas); ++i) {
    questions.ask(pragmas[i], [&](const SqliteQuery& query) {
      numbers[i] = query.integer(0).value_or(0);
      return false;
    });
  }
  return static_cast<std::uint64_t>((numbers[0] - numbers[1]) * numbers[2]);
}

/// Error for a file that cannot be read as a cache; nothing if it can.
std::optional<Error> find_fault(const fs::path& path) {
  const std::string name = path.string();
  const Error no_cache{name + ": is not a cache; caches are what `preload` and `view` fill from a source"};
  std::error_code error;
  if (!fs::exists(path, error)) return Error{name + ": no such file"};
  if (!fs::is_regular_file(path, error)) return no_cache;
  if (fs::file_size(path, error) == 0) return Error{name + ": is empty; preload it again, or leave it out"};
  if (!is_sqlite_file(path)) return no_cache;
  Result<SqliteReader, SqlError> reader = SqliteReader::open(path, kMaxTileBytes);
  const Result<bool, SqlError> has = reader ? reader->has_table(kCacheTable) : reader.error();
  if (!has && has.error().problem == SqlProblem::broken) return damaged(path, has.error());
  if (!has) return Error{fmt::format("{}: the cache cannot be read: {}", name, has.error().message)};
  return *has ? std::nullopt : std::optional(no_cache);
}

void count(Questions& questions, CacheReport& report, std::int64_t now_unix_s) {
  questions.ask(
      "SELECT count(*), count(CASE WHEN s.expires <= ?1 THEN 1 END), count(CASE WHEN s.used IS NULL THEN s.id END) "
      "FROM tiles t LEFT JOIN terrella_cache_tiles s ON s.id = t.id",
      [&](const SqliteQuery& query) {
        report.tiles = query.integer(0).value_or(0);
        report.expired_tiles = query.integer(1).value_or(0);
        report.pinned_tiles = query.integer(2).value_or(0);
        return false;
      },
      now_unix_s);
  questions.ask(
      "SELECT kind, count(*), count(CASE WHEN expires <= ?1 THEN 1 END) FROM terrella_cache_absences GROUP BY kind",
      [&](const SqliteQuery& query) {
        const auto kind = static_cast<std::size_t>(missing_named(query.text(0).value_or("")));
        report.missing.at(kind) += query.integer(1).value_or(0);
        report.expired_missing.at(kind) += query.integer(2).value_or(0);
        return true;
      },
      now_unix_s);
}

}  // namespace

bool is_cache(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || !is_sqlite_file(path)) return false;
  Result<SqliteReader, SqlError> reader = SqliteReader::open(path, kMaxTileBytes);
  if (!reader) return false;
  const Result<bool, SqlError> has = reader->has_table(kCacheTable);
  return has && *has;
}

std::string read_cache_source(const fs::path& path) {
  if (!is_cache(path)) return {};
  Questions questions(path);
  std::string source = questions.text("SELECT value FROM terrella_cache WHERE key = 'source'");
  return questions.error() ? std::string() : source;
}

Result<CacheReport> read_cache_report(const fs::path& path, std::int64_t now_unix_s) {
  if (std::optional<Error> fault = find_fault(path)) return *fault;
  Questions questions(path);
  CacheReport report;
  report.source_key = questions.text("SELECT value FROM terrella_cache WHERE key = 'source'");
  const std::string text =
      questions.text(fmt::format("SELECT value FROM {} WHERE key = '{}'", kTileSetTable, kTileSetKey));
  count(questions, report, now_unix_s);
  report.used_bytes = used_bytes(questions);
  if (questions.error()) return *questions.error();
  Result<TileSetInfo> info = parse_tileset_json(text, path.string());
  if (!info) return info.error();
  report.info = *std::move(info);
  return report;
}

Result<CacheReport> verify_cache(const fs::path& path, std::int64_t now_unix_s) {
  Result<CacheReport> report = read_cache_report(path, now_unix_s);
  if (!report) return report;
  // The check is one long step of SQLite's virtual machine, so it must run without a limit on the time for a row.
  WriteResult<SqliteWriter> database = SqliteWriter::open(path, SqliteWriter::Mode::read);
  if (!database) return Error{fmt::format("{}: cannot be read: {}", path.string(), database.error().message)};
  std::vector<std::string>& problems = report->problems.emplace();
  WriteResult<SqliteStatement> check = database->prepare(fmt::format("PRAGMA integrity_check({})", kMaxProblems));
  WriteResult<bool> more = check ? check->step() : WriteResult<bool>(check.error());
  for (; more && *more; more = check->step()) {
    if (check->text(0) != "ok") problems.push_back(check->text(0));
  }
  if (!more) problems.push_back(more.error().message);
  return report;
}

}  // namespace terrella
