#include "streaming/cache/cache_schema.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "streaming/cache/cache_part.h"
#include "streaming/sets/gpkg_schema.h"
#include "streaming/sets/tileset_json.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

// clang-format off
constexpr std::array kSideTables = {
    "CREATE TABLE terrella_cache (key TEXT PRIMARY KEY, value TEXT NOT NULL)",
    "CREATE TABLE terrella_cache_tiles (id INTEGER PRIMARY KEY, etag TEXT NOT NULL, last_modified TEXT NOT NULL, "
    "stored INTEGER NOT NULL, expires INTEGER, used INTEGER)",
    // Root tiles have no last use, because they are never evicted. The index omits them.
    "CREATE INDEX terrella_cache_tiles_used ON terrella_cache_tiles (used) WHERE used IS NOT NULL",
    "CREATE TABLE terrella_cache_absences (zoom_level INTEGER NOT NULL, tile_column INTEGER NOT NULL, "
    "tile_row INTEGER NOT NULL, kind TEXT NOT NULL, why TEXT NOT NULL, etag TEXT NOT NULL, last_modified TEXT NOT NULL, "
    "stored INTEGER NOT NULL, expires INTEGER, PRIMARY KEY (zoom_level, tile_column, tile_row)) WITHOUT ROWID",
    "CREATE INDEX terrella_cache_absences_stored ON terrella_cache_absences (stored)",
};
// clang-format on

constexpr std::array kNames = {"absent", "blank", "broken", "failed"};

WriteResult<bool> has(SqliteWriter& database, const std::string& condition) {
  const WriteResult<std::int64_t> count = database.integer("SELECT count(*) FROM sqlite_master WHERE " + condition);
  if (!count) return count.error();
  return *count > 0;
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result.append(c == '\'' ? 2 : 1, c);
  return result + "'";
}

/// Checks that the definitions of all written tables are exactly Terrella's, without foreign triggers or indexes. Other
/// definitions (expressions, defaults, virtual tables) would run with each write.
WriteResult<bool> tables_are_ours(SqliteWriter& database) {
  std::string expected = quoted(tile_table_sql("tiles"));
  for (const char* sql : kSideTables) expected += ", " + quoted(sql);
  const std::string on_ours =
      "lower(tbl_name) IN ('tiles', 'terrella_cache', 'terrella_cache_tiles', "
      "'terrella_cache_absences') AND sql IS NOT NULL";
  const auto right = database.integer("SELECT count(*) FROM sqlite_master WHERE sql IN (" + expected + ")");
  if (!right) return right.error();
  const auto all = database.integer("SELECT count(*) FROM sqlite_master WHERE " + on_ours);
  if (!all) return all.error();
  constexpr auto kExpected = static_cast<std::int64_t>(kSideTables.size()) + 1;
  return *right == kExpected && *all == kExpected;
}

WriteStatus write_all(SqliteWriter& database, const TileSetInfo& info, const std::string& source_key) {
  for (const SqlStatement& statement : geopackage_schema(info)) {
    if (WriteStatus done = database.run(statement); !done) return done;
  }
  for (const char* sql : kSideTables) {
    if (WriteStatus done = database.run(sql); !done) return done;
  }
  // Byte ranges of a file are no tiles that another program could show.
  if (source_key.starts_with(kRangesKey)) {
    const WriteStatus done = database.run("UPDATE gpkg_contents SET data_type = 'terrella:ranges'");
    if (!done) return done;
  }
  return database.run({"INSERT INTO terrella_cache VALUES ('version', ?1), ('source', ?2)",
                       {std::to_string(kCacheVersion), source_key}});
}

WriteStatus write_file(const fs::path& part, const TileSetInfo& info, const std::string& source_key) {
  WriteResult<SqliteWriter> database = SqliteWriter::open(part, SqliteWriter::Mode::create);
  if (!database) return database.error();
  return write_cache_schema(*database, info, source_key);
}

/// Deletes the log of a file that somebody deleted without it. SQLite would write that log's pages into the new file.
void remove_old_log(const fs::path& path) {
  // In this order: a log that another process has just begun has its file.
  for (const char* ending : {"-wal", "-shm", "-journal"}) {
    std::error_code failed;
    const fs::path log = path.string() + ending;
    if (fs::exists(log, failed) && !fs::exists(path, failed) && !failed) fs::remove(log, failed);
  }
}

/// Gives the file its name unless that name exists. Returns 0 or errno.
int give_name(const fs::path& part, const fs::path& path) {
  if (link(part.c_str(), path.c_str()) == 0) return 0;
  if (errno == EEXIST) return 0;
  // File systems of memory cards do not support hard links.
  std::error_code failed;
  if (!fs::exists(path, failed)) fs::rename(part, path, failed);
  return failed.value();
}

/// Refuses views and virtual tables, because their code would run with each write.
WriteResult<bool> descriptions_are_tables(SqliteWriter& database) {
  const auto tables = database.integer(
      "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND sql LIKE 'CREATE TABLE %' AND name IN "
      "('gpkg_contents', 'gpkg_tile_matrix', 'terrella_tileset')");
  if (!tables) return tables.error();
  return *tables == 3;
}

/// Call in a transaction: another process may have extended the file since it was checked.
WriteStatus add_levels(SqliteWriter& database, const TileGrid& grid) {
  const auto text = database.text(fmt::format("SELECT value FROM {} WHERE key = '{}'", kTileSetTable, kTileSetKey));
  if (!text) return text.error();
  Result<TileSetInfo> held = parse_tileset_json(*text, "its description");
  if (!held) return WriteError{WriteProblem::other, held.error().message};
  TileGrid& all = held->grid;
  const TileGrid before = all;
  all.min_level = std::min(before.min_level, grid.min_level);
  all.max_level = std::max(before.max_level, grid.max_level);
  for (int level = all.min_level; level <= all.max_level; ++level) {
    if (level >= before.min_level && level <= before.max_level) continue;
    if (WriteStatus added = database.run(tile_matrix_row(*held, level)); !added) return added;
  }
  const SqlStatement changes[] = {
      {fmt::format("UPDATE {} SET value = ?2 WHERE key = ?1", kTileSetTable), {kTileSetKey, to_tileset_json(*held)}},
      {"UPDATE gpkg_contents SET last_change = strftime('%Y-%m-%dT%H:%M:%fZ', 'now') WHERE table_name = 'tiles'", {}}};
  for (const SqlStatement& change : changes) {
    if (WriteStatus done = database.run(change); !done) return done;
  }
  return Done{};
}

}  // namespace

const char* missing_name(MissingKind kind) { return kNames.at(static_cast<std::size_t>(kind)); }

MissingKind missing_named(const std::string& name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames.at(i)) return static_cast<MissingKind>(i);
  }
  return MissingKind::failed;
}

WriteStatus write_cache_schema(SqliteWriter& database, const TileSetInfo& info, const std::string& source_key) {
  const std::string pragmas[] = {fmt::format("PRAGMA page_size = {}", kCachePageBytes),
                                 "PRAGMA auto_vacuum = INCREMENTAL"};
  for (const std::string& pragma : pragmas) {
    if (WriteStatus done = database.run(pragma); !done) return done;
  }
  if (WriteStatus begun = database.run("BEGIN"); !begun) return begun;
  if (WriteStatus written = write_all(database, info, source_key); !written) return written;
  return database.run("COMMIT");
}

Status create_cache_file(const fs::path& path, const TileSetInfo& info, const std::string& source_key) {
  const auto cannot = [&](const std::string& why) {
    return Error{
        fmt::format("{}: the cache cannot be made: {}; name a file in a folder that can be written, with space",
                    path.string(), why)};
  };
  const fs::path folder = path.parent_path().empty() ? fs::path(".") : path.parent_path();
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const fs::path part = cache_part_name(path);
  const int file = open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return cannot(std::strerror(errno));
  close(file);
  const WriteStatus written = write_file(part, info, source_key);
  remove_old_log(path);
  const int named = written ? give_name(part, path) : 0;
  remove_database(part);
  if (!written) return cannot(written.error().message);
  if (named != 0) return cannot(std::strerror(named));
  return Done{};
}

bool has_levels_of(const TileGrid& grid, const TileGrid& wanted) {
  return grid.min_level <= wanted.min_level && grid.max_level >= wanted.max_level;
}

WriteStatus extend_levels(SqliteWriter& database, const TileGrid& grid) {
  const WriteResult<bool> plain = descriptions_are_tables(database);
  if (!plain) return plain.error();
  if (!*plain) return WriteError{WriteProblem::other, "another program has changed its tables; name another file"};
  if (WriteStatus begun = database.run("BEGIN IMMEDIATE"); !begun) return begun;
  WriteStatus done = add_levels(database, grid);
  if (done) done = database.run("COMMIT");
  if (!done) static_cast<void>(database.run("ROLLBACK"));
  return done;
}

WriteResult<FileKind> kind_of(SqliteWriter& database) {
  const WriteResult<bool> cache = has(database, "lower(name) = 'terrella_cache'");
  if (!cache) return cache.error();
  if (!*cache) {
    const WriteResult<bool> tile_set = has(database, "lower(name) IN ('gpkg_contents', 'metadata')");
    if (!tile_set) return tile_set.error();
    return *tile_set ? FileKind::tile_set : FileKind::other;
  }
  const WriteResult<bool> ours = tables_are_ours(database);
  if (!ours) return ours.error();
  if (!*ours) {
    // A later version may have other tables. Its own version number is trusted, because nothing is written then.
    const auto version = database.text("SELECT value FROM terrella_cache WHERE key = 'version'");
    const bool newer = version && version->size() < 9 && std::atoi(version->c_str()) > kCacheVersion;
    return newer ? FileKind::newer : FileKind::tampered;
  }
  const auto version = database.text("SELECT value FROM terrella_cache WHERE key = 'version'");
  if (!version) return version.error();
  if (*version == std::to_string(kCacheVersion)) return FileKind::cache;
  return std::atoi(version->c_str()) > kCacheVersion ? FileKind::newer : FileKind::tampered;
}

}  // namespace terrella
