#include "streaming/cache/merge_caches.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <numeric>
#include <optional>
#include <string>

#include "streaming/cache/cache_database.h"
#include "streaming/cache/cache_part.h"
#include "streaming/cache/cache_rows.h"
#include "streaming/cache/cache_schema.h"
#include "streaming/sets/directory_source.h"
#include "streaming/sqlite_reader.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kRowsPerReport = 256;

// clang-format off
/// Tiles in the order of the file, for a single sequential read.
constexpr const char* kTilesSql =
    "SELECT zoom_level, tile_column, tile_row, tile_data, NULL, '', s.etag, s.last_modified, s.stored, s.expires, s.used, "
    "s.id IS NOT NULL AND s.used IS NULL FROM tiles t LEFT JOIN terrella_cache_tiles s ON s.id = t.id ORDER BY t.id";
constexpr const char* kMissingSql =
    "SELECT zoom_level, tile_column, tile_row, NULL, kind, why, etag, last_modified, stored, expires, NULL, 0 "
    "FROM terrella_cache_absences";
// clang-format on

/// True if a record replaces the known record of its place: a tile replaces any missing-tile record, else the later
/// record wins.
bool wins(const CacheRecord& record, const CacheRows::Known& known) {
  if (!record.missing) return !known.tile_stored || record.stored_unix_s >= *known.tile_stored;
  if (known.tile_stored) return false;
  return !known.missing_stored || record.stored_unix_s >= *known.missing_stored;
}

struct Row {
  TileId id;
  CacheRecord record;
  std::int64_t used = 0;
};

Row row_of(const SqliteQuery& query) {
  Row row{.id = {static_cast<int>(query.integer(0).value_or(0)), query.integer(1).value_or(0),
                 query.integer(2).value_or(0)},
          .record = {},
          .used = query.integer(10).value_or(0)};
  CacheRecord& record = row.record;
  if (const auto bytes = query.blob(3)) record.bytes.assign(bytes->begin(), bytes->end());
  if (const auto kind = query.text(4)) record.missing = missing_named(*kind);
  record.why = query.text(5).value_or("");
  record.etag = query.text(6).value_or("");
  record.last_modified = query.text(7).value_or("");
  record.stored_unix_s = query.integer(8).value_or(0);
  record.expires_unix_s = query.integer(9);
  record.pinned = query.integer(11).value_or(0) != 0;
  return row;
}

/// The result while it is made. The destructor deletes the file unless it got its final name.
class MergedFile {
 public:
  explicit MergedFile(const fs::path& output) : output_(output), part_(cache_part_name(output)) {
    std::error_code ignored;
    fs::create_directories(part_.parent_path(), ignored);
    remove_dead_parts(output);
  }
  ~MergedFile() {
    rows_.reset();
    database_.reset();
    remove_database(part_);
  }
  MergedFile(const MergedFile&) = delete;
  MergedFile& operator=(const MergedFile&) = delete;

  [[nodiscard]] Status begin(const CacheReport& first) { return status(write_head(first)); }

  [[nodiscard]] WriteStatus add(const Row& row, MergeSummary& summary) {
    const WriteResult<CacheRows::Known> known = rows_->known(row.id);
    if (!known) return known.error();
    const bool better = wins(row.record, *known);
    const bool had = known->tile_stored || known->missing_stored;
    summary.dropped += had ? 1 : 0;
    if (!better && row.record.pinned) {
      const auto pinned = rows_->pin(row.id, {.last_y = row.id.y});
      return pinned ? WriteStatus(Done{}) : WriteStatus(pinned.error());
    }
    if (!better) return Done{};
    summary.tiles += (row.record.missing ? 0 : 1) - (known->tile_stored ? 1 : 0);
    summary.missing += (row.record.missing ? 1 : 0) - (known->missing_stored ? 1 : 0);
    return rows_->put(row.id, row.record, row.used);
  }

  [[nodiscard]] Status finish() {
    rows_.reset();
    if (Status done = status(database_->run("COMMIT")); !done) return done;
    database_.reset();
    const int file = open(part_.c_str(), O_RDONLY | O_CLOEXEC);
    if (file >= 0) {
      fsync(file);
      close(file);
    }
    std::error_code failed;
    fs::rename(part_, output_, failed);
    if (failed) return Error{fmt::format("{}: cannot be written: {}", output_.string(), failed.message())};
    return Done{};
  }

  [[nodiscard]] Status status(const WriteStatus& done) const {
    if (done) return Done{};
    return Error{fmt::format("{}: cannot be written: {}{}", output_.string(), done.error().message,
                             done.error().problem == WriteProblem::full ? "; make space and run it again" : "")};
  }

 private:
  /// The pages of the indexes of some millions of tiles stay in memory, because last uses come in no order.
  WriteStatus write_head(const CacheReport& first) {
    WriteResult<SqliteWriter> database = SqliteWriter::make_private(part_);
    if (!database) return database.error();
    database_ = *std::move(database);
    if (WriteStatus done = write_cache_schema(*database_, first.info, first.source_key); !done) return done;
    if (WriteStatus done = database_->run("BEGIN"); !done) return done;
    WriteResult<CacheRows> rows = CacheRows::prepare(*database_, first.info.grid.min_level);
    if (!rows) return rows.error();
    rows_ = *std::move(rows);
    return Done{};
  }

  const fs::path output_;
  const fs::path part_;
  std::optional<SqliteWriter> database_;
  std::optional<CacheRows> rows_;
};

struct Progress {
  const MergeProgress& call;
  std::int64_t done = 0;
  std::int64_t total = 0;
  [[nodiscard]] bool goes_on() { return ++done % kRowsPerReport != 0 || !call || call(done, total); }
};

Status copy_rows(const fs::path& cache, const char* sql, MergedFile& merged, MergeSummary& summary,
                 Progress& progress) {
  const auto unreadable = [&](const SqlError& error) {
    return Error{fmt::format("{}: the cache cannot be read: {}; ‹verify› says more", cache.string(), error.message)};
  };
  Result<SqliteReader, SqlError> reader = SqliteReader::open(cache, kMaxTileBytes);
  if (!reader) return unreadable(reader.error());
  Result<SqliteQuery, SqlError> query = reader->prepare(sql);
  if (!query) return unreadable(query.error());
  Result<bool, SqlError> more = query->step();
  for (; more && *more; more = query->step()) {
    if (Status added = merged.status(merged.add(row_of(*query), summary)); !added) return added;
    if (!progress.goes_on()) return Error{"interrupted; nothing was written, it can be run again"};
  }
  if (!more) return unreadable(more.error());
  return Done{};
}

Status check_output(const std::vector<fs::path>& caches, const fs::path& output) {
  std::error_code error;
  if (!fs::exists(output, error)) return Done{};
  for (const fs::path& cache : caches) {
    if (fs::equivalent(cache, output, error)) return Done{};
  }
  return Error{output.string() + ": is there already; name it among the caches too, or name another output"};
}

}  // namespace

Result<CacheReport> report_together(const std::vector<fs::path>& caches) {
  std::optional<CacheReport> first;
  for (const fs::path& cache : caches) {
    Result<CacheReport> report = read_cache_report(cache, std::time(nullptr));
    if (!report) return report.error();
    if (!first) {
      first = *std::move(report);
    } else if (!same_source(report->source_key, first->source_key)) {
      return Error{fmt::format("{}: holds tiles of {}, and {} of {}; only caches of one source can be joined",
                               cache.string(), report->source_key, caches.front().string(), first->source_key)};
    } else if (!same_tiles(report->info, first->info)) {
      return Error{
          fmt::format("{}: has another grid, extent or format than {}; only caches of one source can be joined",
                      cache.string(), caches.front().string())};
    } else {
      TileGrid& all = first->info.grid;
      all.min_level = std::min(all.min_level, report->info.grid.min_level);
      all.max_level = std::max(all.max_level, report->info.grid.max_level);
      first->tiles += report->tiles;
      for (std::size_t kind = 0; kind < first->missing.size(); ++kind) first->missing[kind] += report->missing[kind];
    }
  }
  if (!first) return Error{"no cache to join; name one or more"};
  return *std::move(first);
}

Result<MergeSummary> merge_caches(const std::vector<fs::path>& caches, const fs::path& output,
                                  const MergeProgress& progress) {
  const Result<CacheReport> first = report_together(caches);
  if (!first) return first.error();
  Progress rows{.call = progress, .total = std::reduce(first->missing.begin(), first->missing.end(), first->tiles)};
  if (Status free = check_output(caches, output); !free) return free.error();
  MergedFile merged(output);
  if (Status begun = merged.begin(*first); !begun) return begun.error();
  MergeSummary summary;
  for (const fs::path& cache : caches) {
    for (const char* sql : {kTilesSql, kMissingSql}) {
      if (Status copied = copy_rows(cache, sql, merged, summary, rows); !copied) return copied.error();
    }
  }
  // Merging takes time; another file may have taken the name meanwhile.
  if (Status free = check_output(caches, output); !free) return free.error();
  if (Status finished = merged.finish(); !finished) return finished.error();
  if (progress) progress(rows.total, rows.total);
  return summary;
}

}  // namespace terrella
