#include "streaming/cache/cache_database.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "streaming/cache/cache_part.h"
#include "streaming/cache/cache_schema.h"
#include "streaming/sets/geopackage_source.h"
#include "streaming/sets/tileset_json.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxSetAside = 10'000;
/// Two processes may find the same damage, or each other's new file. Each round ends with an existing file.
constexpr int kMaxRounds = 8;

/// Result of checking the file: a database, a refusal, or damage.
struct Look {
  std::optional<SqliteWriter> database;
  std::optional<CacheOpenError> refused;
  std::string damage;
};

Look damaged(std::string what) {
  Look look;
  look.damage = std::move(what);
  return look;
}
Look refused(Error error, bool cannot_write = false) {
  Look look;
  look.refused = CacheOpenError{std::move(error), cannot_write};
  return look;
}
Look failed(const fs::path& path, const WriteError& error) {
  return error.problem == WriteProblem::damaged ? damaged(error.message) : refused(cache_error(path, error), true);
}

/// Inode number of the file, which ensures that exactly the checked file is renamed.
std::optional<ino_t> number_of(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return std::nullopt;
  return status.st_ino;
}

/// Returns an empty text for a sound file. The size of the checked part bounds the time, because SQLite 3.40 cannot
/// interrupt a check.
WriteResult<std::string> find_damage(SqliteWriter& database, const fs::path& path) {
  std::error_code error;
  const bool small = fs::file_size(path, error) <= kMaxQuickCheckBytes;
  const char* side = "PRAGMA quick_check('terrella_cache')";
  WriteResult<std::string> said = database.text(small ? "PRAGMA quick_check(1)" : side);
  if (said && *said == "ok") return std::string();
  return said;
}

std::optional<Error> kind_refusal(FileKind kind, const fs::path& path) {
  const std::string name = path.string();
  switch (kind) {
    case FileKind::tile_set:
      return Error{name + ": is a tile set, not a cache; name another file as the cache"};
    case FileKind::other:
      return Error{name + ": is an SQLite database of another program, not a cache; name another file as the cache"};
    case FileKind::newer:
      return Error{name + ": is a cache of a later version of terrella; name another file, or use that version"};
    case FileKind::cache:
    case FileKind::tampered:
      break;
  }
  return std::nullopt;
}

/// Refuses another source's tiles instead of setting them aside, because they are worth keeping.
Look check_source(SqliteWriter database, const fs::path& path, const TileSetInfo& info, const std::string& key) {
  const auto source = database.text("SELECT value FROM terrella_cache WHERE key = 'source'");
  if (!source) return failed(path, source.error());
  const auto text = database.text(fmt::format("SELECT value FROM {} WHERE key = '{}'", kTileSetTable, kTileSetKey));
  if (!text) return failed(path, text.error());
  const Result<TileSetInfo> held = parse_tileset_json(*text, path.string());
  if (!held) return damaged(held.error().message);
  if (!same_source(*source, key)) {
    return refused(
        {fmt::format("{}: holds tiles of {}, not of {}; name another file as the cache", path.string(), *source, key)});
  }
  if (!same_tiles(*held, info)) {
    return refused(
        {fmt::format("{}: holds tiles of {} in another grid, extent or format than it has now; name another "
                     "file as the cache, or delete this one",
                     path.string(), *source)});
  }
  if (!has_levels_of(held->grid, info.grid)) {
    if (WriteStatus extended = extend_levels(database, info.grid); !extended) {
      if (extended.error().problem != WriteProblem::other) return failed(path, extended.error());
      return refused({fmt::format("{}: levels cannot be added to it: {}", path.string(), extended.error().message)},
                     true);
    }
  }
  Look look;
  look.database = std::move(database);
  return look;
}

/// Writes nothing to the file before it is known to be Terrella's and sound.
Look look_at(const fs::path& path, const TileSetInfo& info, const std::string& source_key,
             const std::function<void()>& on_locked) {
  if (!is_sqlite_file(path)) return damaged("not an SQLite database");
  WriteResult<SqliteWriter> database = SqliteWriter::open(path, SqliteWriter::Mode::existing, on_locked);
  if (!database) return failed(path, database.error());
  database->leave_log_on_close(true);
  const WriteResult<FileKind> kind = kind_of(*database);
  if (!kind) return failed(path, kind.error());
  if (std::optional<Error> refusal = kind_refusal(*kind, path)) return refused(*refusal);
  if (*kind == FileKind::tampered) return damaged("its tables are not those of a cache");
  const WriteResult<std::string> damage = find_damage(*database, path);
  if (!damage) return failed(path, damage.error());
  if (!damage->empty()) return damaged(*damage);
  return check_source(*std::move(database), path, info, source_key);
}

/// Renames the file and its log. Returns an empty path if the file was gone, or was no longer the checked file.
Result<fs::path> set_aside(const fs::path& path, std::optional<ino_t> looked_at) {
  for (int n = 1; n <= kMaxSetAside; ++n) {
    const fs::path aside = path.string() + fmt::format(".damaged-{}", n);
    std::error_code error;
    if (fs::exists(fs::symlink_status(aside, error))) continue;
    if (number_of(path) != looked_at) return fs::path();
    fs::rename(path, aside, error);
    if (error) {
      return Error{
          fmt::format("{}: is damaged and cannot be renamed: {}; move it away", path.string(), error.message())};
    }
    for (const char* ending : {"-wal", "-shm", "-journal"}) {
      fs::rename(path.string() + ending, aside.string() + ending, error);
    }
    return aside;
  }
  return Error{path.string() + ": is damaged, and so were many before it; delete what you do not need of them"};
}

}  // namespace

bool same_tiles(const TileSetInfo& a, const TileSetInfo& b) {
  const auto essence = [](TileSetInfo info) {
    info.name.clear();
    info.attribution.clear();
    info.body.clear();
    info.grid.min_level = info.grid.max_level = 0;
    return to_tileset_json(info);
  };
  return essence(a) == essence(b) && columns(a.grid, 0) == columns(b.grid, 0) && rows(a.grid, 0) == rows(b.grid, 0);
}

bool same_source(const std::string& a, const std::string& b) {
  if (a == b) return true;
  using nlohmann::json;
  json one = json::parse(a, nullptr, false);
  json other = json::parse(b, nullptr, false);
  if (!one.is_object() || !other.is_object()) return false;
  // For lists of levels, the shorter list must be a prefix of the longer one.
  for (const char* list : {"levels", "shifts"}) {
    if (!one[list].is_array() || !other[list].is_array()) return false;
    if (one[list].size() > other[list].size()) std::swap(one[list], other[list]);
    const json& shorter = one[list];
    const json& longer = other[list];
    if (shorter.empty() != longer.empty() || !std::equal(shorter.begin(), shorter.end(), longer.begin())) return false;
    one[list] = longer;
  }
  return one == other;
}

Error cache_error(const fs::path& path, const WriteError& error) {
  const char* advice = "";
  if (error.problem == WriteProblem::full) advice = "; make space; what was stored before is safe";
  if (error.problem == WriteProblem::busy) advice = "; close what holds it; what was stored before is safe";
  if (error.problem == WriteProblem::damaged) advice = "; what was stored may be lost; a new run sets the file aside";
  if (error.problem == WriteProblem::other) advice = "; ‹verify› tells what is left of it";
  return Error{fmt::format("{}: the cache cannot be written: {}{}", path.string(), error.message, advice)};
}

Result<OpenedCache, CacheOpenError> open_cache_database(const fs::path& path, const TileSetInfo& info,
                                                        const std::string& source_key,
                                                        const std::function<void()>& on_locked) {
  fs::path aside;
  remove_dead_parts(path);
  for (int round = 0; round < kMaxRounds; ++round) {
    std::error_code error;
    if (fs::is_directory(path, error)) {
      return CacheOpenError{{path.string() + ": is a folder; name a file as the cache"}};
    }
    if (!fs::exists(path, error)) {
      if (Status made = create_cache_file(path, info, source_key); !made) {
        return CacheOpenError{made.error(), true};
      }
    }
    const std::optional<ino_t> number = number_of(path);
    Look look = look_at(path, info, source_key, on_locked);
    if (look.refused) return *look.refused;
    if (!look.database) {
      Result<fs::path> renamed = set_aside(path, number);
      if (!renamed) return CacheOpenError{renamed.error(), true};
      if (!renamed->empty()) aside = *renamed;
      continue;
    }
    if (WriteStatus logged = look.database->run("PRAGMA journal_mode = WAL"); !logged) {
      return CacheOpenError{cache_error(path, logged.error()), true};
    }
    look.database->leave_log_on_close(false);
    look.database->end_wait_for_lock();
    return OpenedCache{*std::move(look.database), aside};
  }
  return CacheOpenError{
      {path.string() + ": is damaged again and again by another program; name another file as the cache"}};
}

}  // namespace terrella
