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

// clang-format off
constexpr std::string_view kPlaces = "zoom_level = ?1 AND tile_column = ?2 AND tile_row BETWEEN ?3 AND ?4";
constexpr std::string_view kAllTiles = "t.id > ?1";
constexpr std::string_view kAllMissing = "1";
constexpr std::string_view kTiles =
    "SELECT t.id, length(t.tile_data) FROM tiles t LEFT JOIN terrella_cache_tiles s ON s.id = t.id WHERE {} "
    "AND (?5 IS NULL OR s.stored < ?5) AND (?6 IS NULL OR s.used < ?6) ORDER BY t.id LIMIT {}";
constexpr std::string_view kMissing =
    "{} FROM terrella_cache_absences WHERE {} AND (?5 IS NULL OR stored < ?5) AND (?6 IS NULL OR stored < ?6)";
constexpr const char* kNextColumn =
    "SELECT min(x) FROM (SELECT min(tile_column) AS x FROM tiles WHERE zoom_level = ?1 AND tile_column >= ?2 UNION ALL "
    "SELECT min(tile_column) FROM terrella_cache_absences WHERE zoom_level = ?1 AND tile_column >= ?2)";
// clang-format on

/// Removes the records run by run. Statements end before the connection does.
class Purge {
 public:
  Purge(SqliteWriter& database, const PurgeWish& wish) : database_(database), wish_(wish) {}

  WriteResult<PurgeSummary> run() {
    if (WriteStatus prepared = prepare(); !prepared) return prepared.error();
    WriteStatus done = wish_.next_places ? purge_places() : purge_all();
    if (done) done = end_step();
    if (!done && begun_) static_cast<void>(database_.run("ROLLBACK"));
    if (done && !wish_.dry_run) done = give_pages_back();
    if (!done) return done.error();
    return summary_;
  }

 private:
  WriteStatus prepare() {
    const bool all = !wish_.next_places;
    const std::pair<std::optional<SqliteStatement>*, std::string> statements[] = {
        {&tiles_, fmt::format(kTiles, all ? kAllTiles : kPlaces, kRowsAtATime)},
        {&missing_, fmt::format(kMissing, wish_.dry_run ? "SELECT count(*)" : "DELETE", all ? kAllMissing : kPlaces)},
        {&drop_tile_, "DELETE FROM tiles WHERE id = ?1"},
        {&drop_side_, "DELETE FROM terrella_cache_tiles WHERE id = ?1"},
        {&next_column_, kNextColumn}};
    for (const auto& [slot, sql] : statements) {
      WriteResult<SqliteStatement> statement = database_.prepare(sql);
      if (!statement) return statement.error();
      *slot = *std::move(statement);
    }
    for (SqliteStatement* statement : {&*tiles_, &*missing_}) {
      statement->bind(5, wish_.stored_before_unix_s);
      statement->bind(6, wish_.used_before_unix_s);
    }
    return Done{};
  }

  WriteStatus purge_all() {
    std::int64_t last = std::numeric_limits<std::int64_t>::min();
    for (bool more = true; more;) {
      if (WriteStatus begun = begin_step(); !begun) return begun;
      tiles_->bind(1, last);
      const auto rows = purge_tiles();
      if (!rows) return rows.error();
      more = !rows->empty();
      if (more) last = rows->back();
      if (more && stops()) return Done{};
    }
    return purge_missing();
  }

  WriteStatus purge_places() {
    while (const auto run = wish_.next_places()) {
      if (stops()) return Done{};
      const WriteResult<bool> used = has_column(*run);
      if (!used) return used.error();
      for (std::int64_t y = run->first_y; *used && y <= run->last_y; y += kRowsAtATime) {
        if (WriteStatus begun = begin_step(); !begun) return begun;
        for (SqliteStatement* statement : {&*tiles_, &*missing_}) {
          statement->bind(1, std::int64_t{run->level});
          statement->bind(2, run->x);
          statement->bind(3, y);
          statement->bind(4, std::min(run->last_y, y + kRowsAtATime - 1));
        }
        if (const auto rows = purge_tiles(); !rows) return rows.error();
        if (WriteStatus done = purge_missing(); !done) return done;
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
    next_x_ = none ? std::numeric_limits<std::int64_t>::max() : next_column_->integer(0);
    next_column_->reset();
    if (!row) return row.error();
    return run.x == next_x_;
  }

  /// Removes the tiles of the bound places. Returns their rows.
  WriteResult<std::vector<std::int64_t>> purge_tiles() {
    std::vector<std::int64_t> rows;
    WriteResult<bool> more = tiles_->step();
    for (; more && *more; more = tiles_->step()) {
      rows.push_back(tiles_->integer(0));
      summary_.tile_bytes += tiles_->integer(1);
    }
    tiles_->reset();
    if (!more) return more.error();
    summary_.tiles += static_cast<std::int64_t>(rows.size());
    in_step_ += static_cast<std::int64_t>(rows.size());
    if (wish_.dry_run) return rows;
    for (const std::int64_t row : rows) {
      for (SqliteStatement* drop : {&*drop_tile_, &*drop_side_}) {
        drop->bind(1, row);
        if (WriteStatus dropped = drop->run(); !dropped) return dropped.error();
      }
    }
    return rows;
  }

  WriteStatus purge_missing() {
    if (!wish_.dry_run) {
      if (WriteStatus dropped = missing_->run(); !dropped) return dropped;
      summary_.missing += database_.changed_rows();
      return Done{};
    }
    const WriteResult<bool> row = missing_->step();
    if (row && *row) summary_.missing += missing_->integer(0);
    missing_->reset();
    return row ? WriteStatus(Done{}) : WriteStatus(row.error());
  }

  bool stops() {
    summary_.stopped = summary_.stopped || (wish_.goes_on && !wish_.goes_on());
    return summary_.stopped;
  }

  WriteStatus begin_step() {
    if (in_step_ >= kRowsAtATime) {
      if (WriteStatus ended = end_step(); !ended) return ended;
    }
    if (begun_) return Done{};
    WriteStatus begun = database_.run(wish_.dry_run ? "BEGIN" : "BEGIN IMMEDIATE");
    begun_ = bool(begun);
    return begun;
  }
  WriteStatus end_step() {
    in_step_ = 0;
    return std::exchange(begun_, false) ? database_.run("COMMIT") : WriteStatus(Done{});
  }

  WriteStatus give_pages_back() {
    while (true) {
      const WriteResult<std::int64_t> pages = database_.integer("PRAGMA freelist_count");
      if (!pages) return pages.error();
      if (*pages == 0) return Done{};
      WriteStatus freed = database_.run(fmt::format("PRAGMA incremental_vacuum({})", kPagesAtATime));
      if (!freed) return freed;
      if (const auto left = database_.integer("PRAGMA freelist_count"); !left || *left >= *pages) return Done{};
    }
  }

  SqliteWriter& database_;
  const PurgeWish& wish_;
  PurgeSummary summary_;
  std::optional<SqliteStatement> tiles_, missing_, drop_tile_, drop_side_, next_column_;
  bool begun_ = false;  ///< a transaction is open
  std::int64_t in_step_ = 0;
  // has_column(): the columns [looked_from_, next_x_) of the level have no record, next_x_ has one.
  int level_ = -1;
  std::int64_t looked_from_ = 0, next_x_ = 0;
};

/// Writes the log back, and leaves a plain file if no other program has it open.
void tidy_up(SqliteWriter& database) {
  static_cast<void>(database.integer("PRAGMA wal_checkpoint(TRUNCATE)"));
  database.wait_for_locks(std::chrono::milliseconds(0));
  static_cast<void>(database.run("PRAGMA journal_mode = DELETE"));
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
  if (!database) return cache_error(path, database.error());
  const WriteResult<FileKind> kind = kind_of(*database);
  if (!kind) return cache_error(path, kind.error());
  if (*kind == FileKind::newer) {
    return Error{path.string() + ": is a cache of a later version of terrella; use that version"};
  }
  if (*kind == FileKind::tampered) {
    return Error{path.string() + ": its tables are not those of a cache; ‹preload› sets it aside and begins anew"};
  }
  if (*kind != FileKind::cache) return no_cache;
  const std::uintmax_t before = fs::file_size(path, failed);
  WriteResult<PurgeSummary> summary = Purge(*database, wish).run();
  if (!wish.dry_run) tidy_up(*database);
  if (!summary) return cache_error(path, summary.error());
  summary->file_bytes_before = before;
  summary->file_bytes = fs::file_size(path, failed);
  return *std::move(summary);
}

}  // namespace terrella
