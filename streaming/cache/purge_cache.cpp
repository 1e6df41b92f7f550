#include "streaming/cache/purge_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "streaming/cache/cache_database.h"
#include "streaming/cache/cache_schema.h"
#include "streaming/cache/sqlite_writer.h"
#include "streaming/sets/geopackage_source.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Other programs get the file between two steps.
constexpr std::int64_t kRowsAtATime = 4096;
constexpr int kPagesAtATime = 4096;
// The log is written back when it is longer than this, unless another program reads from it for longer than this.
constexpr std::uintmax_t kMostLogBytes = 32UL << 20;
constexpr std::chrono::milliseconds kReaderPatience{200};
constexpr std::int64_t kLeastId = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kMostId = std::numeric_limits<std::int64_t>::max();

// clang-format off
constexpr std::string_view kPlaces = "zoom_level = ?1 AND tile_column = ?2 AND tile_row BETWEEN ?3 AND ?4";
constexpr std::string_view kSomeTiles = "t.id BETWEEN ?1 AND ?2";
constexpr std::string_view kSomeMissing =
    "(zoom_level, tile_column, tile_row) > (?1, ?2, ?3) AND (zoom_level, tile_column, tile_row) <= (?7, ?8, ?9)";
constexpr std::string_view kTiles =
    "SELECT t.id, length(t.tile_data) FROM tiles t LEFT JOIN terrella_cache_tiles s ON s.id = t.id WHERE {} "
    "AND (?5 IS NULL OR s.stored < ?5) AND (?6 IS NULL OR s.used < ?6)";
constexpr std::string_view kMissing =
    "{} FROM terrella_cache_absences WHERE {} AND (?5 IS NULL OR stored < ?5) AND (?6 IS NULL OR stored < ?6)";
constexpr const char* kNextTile = "SELECT min(id) FROM tiles WHERE id > ?1";
constexpr std::string_view kLastMissing =
    "SELECT zoom_level, tile_column, tile_row FROM terrella_cache_absences WHERE (zoom_level, tile_column, tile_row) > "
    "(?1, ?2, ?3) ORDER BY zoom_level, tile_column, tile_row LIMIT 1 OFFSET {}";
constexpr const char* kNextColumn =
    "SELECT min(x) FROM (SELECT min(tile_column) AS x FROM tiles WHERE zoom_level = ?1 AND tile_column >= ?2 UNION ALL "
    "SELECT min(tile_column) FROM terrella_cache_absences WHERE zoom_level = ?1 AND tile_column >= ?2)";
// clang-format on

/// Writes the log back, so that it stays short while other programs have the file open.
void write_log_back(SqliteWriter& database) {
  database.wait_for_locks(kReaderPatience);
  static_cast<void>(database.integer("PRAGMA wal_checkpoint(TRUNCATE)"));
  database.wait_for_locks(SqliteWriter::kLockPatience);
}

/// Removes the records step by step. Statements end before the connection does.
class Purge {
 public:
  Purge(SqliteWriter& database, const fs::path& path, const PurgeWish& wish)
      : database_(database), log_(path.string() + "-wal"), wish_(wish) {}

  WriteStatus run() {
    if (WriteStatus prepared = prepare(); !prepared) return prepared;
    if (WriteStatus done = wish_.next_places ? purge_places() : purge_all(); !done) return done;
    return wish_.dry_run ? WriteStatus(Done{}) : give_pages_back();
  }
  /// The counts of all ended steps, also after an error.
  [[nodiscard]] const PurgeSummary& summary() const { return summary_; }

 private:
  /// Records of one step.
  struct Found {
    std::vector<std::int64_t> rows;  ///< ids of tiles
    std::int64_t tile_bytes = 0;
    std::int64_t missing = 0;
  };

  WriteStatus prepare() {
    const bool all = !wish_.next_places;
    const std::string_view missing = all ? kSomeMissing : kPlaces;
    const std::pair<std::optional<SqliteStatement>*, std::string> statements[] = {
        {&tiles_, fmt::format(kTiles, all ? kSomeTiles : kPlaces)},
        {&missing_, fmt::format(kMissing, "SELECT count(*)", missing)},
        {&drop_missing_, fmt::format(kMissing, "DELETE", missing)},
        {&drop_tile_, "DELETE FROM tiles WHERE id = ?1"},
        {&drop_side_, "DELETE FROM terrella_cache_tiles WHERE id = ?1"},
        {&next_tile_, kNextTile},
        {&last_missing_, fmt::format(kLastMissing, kRowsAtATime - 1)},
        {&next_column_, kNextColumn}};
    for (const auto& [slot, sql] : statements) {
      WriteResult<SqliteStatement> statement = database_.prepare(sql);
      if (!statement) return statement.error();
      *slot = *std::move(statement);
    }
    for (SqliteStatement* statement : {&*tiles_, &*missing_, &*drop_missing_}) {
      statement->bind(5, wish_.stored_before_unix_s);
      statement->bind(6, wish_.used_before_unix_s);
    }
    return Done{};
  }

  // Unbound places fit no record: the first steps find tiles alone, the later ones no tile.
  WriteStatus purge_all() {
    for (std::int64_t last = kLeastId; !stops();) {
      next_tile_->bind(1, last);
      const WriteResult<bool> row = next_tile_->step();
      const bool none = !row || !*row || next_tile_->is_null(0);
      const std::int64_t first = none ? 0 : next_tile_->integer(0);
      next_tile_->reset();
      if (!row) return row.error();
      last = std::min(first, kMostId - kRowsAtATime + 1) + kRowsAtATime - 1;
      tiles_->bind(1, none ? kMostId : first);
      tiles_->bind(2, none ? kLeastId : last);
      if (none) return purge_all_missing();
      if (WriteStatus done = purge_step(); !done) return done;
    }
    return Done{};
  }

  WriteStatus purge_all_missing() {
    std::int64_t after[] = {kLeastId, kLeastId, kLeastId}, last[] = {kMostId, kMostId, kMostId};
    for (bool more = true; more && !stops();) {
      for (int i = 0; i < 3; ++i) last_missing_->bind(i + 1, after[i]);
      const WriteResult<bool> row = last_missing_->step();
      more = row && *row;
      for (int i = 0; i < 3; ++i) last[i] = more ? last_missing_->integer(i) : kMostId;
      last_missing_->reset();
      if (!row) return row.error();
      for (SqliteStatement* statement : {&*missing_, &*drop_missing_}) {
        for (int i = 0; i < 3; ++i) {
          statement->bind(i + 1, after[i]);
          statement->bind(i + 7, last[i]);
        }
      }
      if (WriteStatus done = purge_step(); !done) return done;
      std::ranges::copy(last, after);
    }
    return Done{};
  }

  WriteStatus purge_places() {
    while (const auto run = wish_.next_places()) {
      if (stops()) return Done{};
      const WriteResult<bool> used = has_column(*run);
      if (!used) return used.error();
      for (std::int64_t y = run->first_y; *used && y <= run->last_y && !stops(); y += kRowsAtATime) {
        for (SqliteStatement* statement : {&*tiles_, &*missing_, &*drop_missing_}) {
          statement->bind(1, std::int64_t{run->level});
          statement->bind(2, run->x);
          statement->bind(3, y);
          statement->bind(4, std::min(run->last_y, y + kRowsAtATime - 1));
        }
        if (WriteStatus done = purge_step(); !done) return done;
      }
    }
    return Done{};
  }

  /// True if a column has records. Looks ahead to the next one that has, because most columns of a plan have none.
  WriteResult<bool> has_column(const PurgeRun& run) {
    if (run.level == level_ && run.x >= looked_from_ && run.x < next_x_) return false;
    if (run.level == level_ && run.x == next_x_) return true;
    next_column_->bind(1, std::int64_t{run.level});
    next_column_->bind(2, run.x);
    const WriteResult<bool> row = next_column_->step();
    const bool none = !row || !*row || next_column_->is_null(0);
    level_ = run.level;
    looked_from_ = run.x;
    next_x_ = none ? kMostId : next_column_->integer(0);
    next_column_->reset();
    if (!row) return row.error();
    return run.x == next_x_;
  }

  /// Removes the records of the bound places. Only a step that finds some takes the file, and looks once more then,
  /// because another program may have renewed them.
  WriteStatus purge_step() {
    WriteResult<Found> found = find();
    if (found && !wish_.dry_run && (!found->rows.empty() || found->missing > 0)) {
      if (WriteStatus begun = database_.run("BEGIN IMMEDIATE"); !begun) return begun;
      found = find();
      WriteStatus dropped = found ? drop(*found) : WriteStatus(found.error());
      if (dropped) dropped = database_.run("COMMIT");
      if (!dropped) {
        static_cast<void>(database_.run("ROLLBACK"));
        return dropped;
      }
      keep_log_short();
    }
    if (!found) return found.error();
    summary_.tiles += static_cast<std::int64_t>(found->rows.size());
    summary_.tile_bytes += found->tile_bytes;
    summary_.missing += found->missing;
    return Done{};
  }

  WriteResult<Found> find() {
    Found found;
    WriteResult<bool> more = tiles_->step();
    for (; more && *more; more = tiles_->step()) {
      found.rows.push_back(tiles_->integer(0));
      found.tile_bytes += tiles_->integer(1);
    }
    tiles_->reset();
    if (!more) return more.error();
    const WriteResult<bool> row = missing_->step();
    if (row && *row) found.missing = missing_->integer(0);
    missing_->reset();
    if (!row) return row.error();
    return found;
  }

  WriteStatus drop(const Found& found) {
    for (const std::int64_t row : found.rows) {
      for (SqliteStatement* drop : {&*drop_tile_, &*drop_side_}) {
        drop->bind(1, row);
        if (WriteStatus dropped = drop->run(); !dropped) return dropped;
      }
    }
    return found.missing > 0 ? drop_missing_->run() : WriteStatus(Done{});
  }

  bool stops() {
    summary_.stopped = summary_.stopped || (wish_.goes_on && !wish_.goes_on());
    return summary_.stopped;
  }

  void keep_log_short() {
    std::error_code none;
    const std::uintmax_t bytes = fs::file_size(log_, none);
    if (!none && bytes > kMostLogBytes) write_log_back(database_);
  }

  WriteStatus give_pages_back() {
    while (!stops()) {
      const WriteResult<std::int64_t> pages = database_.integer("PRAGMA freelist_count");
      if (!pages) return pages.error();
      if (*pages == 0) break;
      WriteStatus freed = database_.run(fmt::format("PRAGMA incremental_vacuum({})", kPagesAtATime));
      if (!freed) return freed;
      keep_log_short();
      if (const auto left = database_.integer("PRAGMA freelist_count"); !left || *left >= *pages) break;
    }
    return Done{};
  }

  SqliteWriter& database_;
  const fs::path log_;
  const PurgeWish& wish_;
  PurgeSummary summary_;
  std::optional<SqliteStatement> tiles_, missing_, drop_missing_, drop_tile_, drop_side_;
  std::optional<SqliteStatement> next_tile_, last_missing_, next_column_;
  // has_column(): the columns [looked_from_, next_x_) of the level have no record, next_x_ has one.
  int level_ = -1;
  std::int64_t looked_from_ = 0, next_x_ = 0;
};

/// Writes the log back, and leaves a plain file if no other program has it open.
void tidy_up(SqliteWriter& database) {
  write_log_back(database);
  database.wait_for_locks(std::chrono::milliseconds(0));
  static_cast<void>(database.run("PRAGMA journal_mode = DELETE"));
}

Error purge_error(const fs::path& path, const WriteError& error, bool dry_run) {
  if (error.problem == WriteProblem::damaged) {
    return Error{
        fmt::format("{}: the cache is damaged: {}; ‹verify› tells what is left of it", path.string(), error.message)};
  }
  if (!dry_run) return cache_error(path, error);
  return Error{
      fmt::format("{}: the cache cannot be read: {}; ‹verify› tells what is left of it", path.string(), error.message)};
}

}  // namespace

Result<PurgeSummary> purge_cache(const fs::path& path, const PurgeWish& wish) {
  const Error no_cache{path.string() +
                       ": is not a cache; only caches that ‹preload› or the viewer filled can be purged"};
  std::error_code failed;
  if (!fs::exists(path, failed)) return Error{path.string() + ": no such file; name a cache"};
  if (!fs::is_regular_file(path, failed) || !is_sqlite_file(path)) return no_cache;
  WriteResult<SqliteWriter> database =
      SqliteWriter::open(path, wish.dry_run ? SqliteWriter::Mode::read : SqliteWriter::Mode::existing);
  if (!database) return purge_error(path, database.error(), wish.dry_run);
  const WriteResult<FileKind> kind = kind_of(*database);
  if (!kind) return purge_error(path, kind.error(), wish.dry_run);
  if (*kind == FileKind::newer) {
    return Error{path.string() + ": is a cache of a later version of terrella; use that version"};
  }
  if (*kind == FileKind::tampered) {
    return Error{path.string() + ": its tables are not those of a cache; ‹preload› sets it aside and begins anew"};
  }
  if (*kind != FileKind::cache) return no_cache;
  const std::uintmax_t before = fs::file_size(path, failed);
  PurgeSummary summary;
  {
    Purge purge(*database, path, wish);
    const WriteStatus done = purge.run();
    summary = purge.summary();
    if (!done) summary.fault = purge_error(path, done.error(), wish.dry_run);
  }
  if (!wish.dry_run) tidy_up(*database);
  summary.file_bytes_before = before;
  summary.file_bytes = fs::file_size(path, failed);
  return summary;
}

}  // namespace terrella
