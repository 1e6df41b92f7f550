#include "streaming/cut/output_claim.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "streaming/cache/cache_schema.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/file_bytes.h"
#include "streaming/pmtiles/pmtiles_set.h"
#include "streaming/sets/geopackage_source.h"
#include "streaming/sets/tileset_json.h"
#include "streaming/sqlite_reader.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Finds a table or view that is not SQLite's own and not among these.
constexpr const char* kForeignTable =
    "SELECT name FROM sqlite_master WHERE type IN ('table', 'view') AND name NOT LIKE 'sqlite\\_%' ESCAPE '\\' AND "
    "name NOT IN ({}) ORDER BY name";
/// Tables of gpkg_schema.cpp.
constexpr const char* kGpkgTables =
    "'gpkg_spatial_ref_sys', 'gpkg_contents', 'gpkg_tile_matrix_set', 'gpkg_tile_matrix', 'gpkg_extensions', "
    "'gpkg_2d_gridded_coverage_ancillary', 'gpkg_2d_gridded_tile_ancillary', 'tiles', 'terrella_tileset', "
    "'terrella_squeezed_tiles'";
constexpr const char* kMbtilesTables = "'metadata', 'tiles'";

/// Error about the existing output. `what` completes the sentence "OUT.gpkg: is …".
Error stays(const OutputClaim& claim, const std::string& what) {
  return Error{
      fmt::format("{}: {}; only tile sets that `cut` or `convert` wrote are replaced: name another output, or move "
                  "this one away",
                  claim.output.string(), what)};
}

Status check_mark(const OutputClaim& claim, const std::string& mark) {
  if (mark == claim.mark || claim.force) return Done{};
  return Error{
      fmt::format("{}: is a tile set that was made from another input; give ‹force› to replace it, or name another "
                  "output",
                  claim.output.string())};
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code failed;
  const fs::path inner = fs::canonical(file, failed);
  const fs::path outer = fs::canonical(folder, failed);
  return !failed && std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

/// Compares files, not names, so that a link to a picture counts as that picture.
Status check_inputs(const OutputClaim& claim, const fs::path& there) {
  for (const fs::path& image : claim.images) {
    std::error_code failed;
    const bool same = fs::equivalent(image, there, failed);
    if (!same && !lies_in(image, there)) continue;
    return Error{fmt::format("{}: {} the input {}; name another output", claim.output.string(), same ? "is" : "holds",
                             image.string())};
  }
  return Done{};
}

/// A journal beside the output belongs to a program that writes there, or was interrupted.
Status check_journals(const OutputClaim& claim) {
  for (const char* ending : {"-journal", "-wal"}) {
    const fs::path journal = claim.output.string() + ending;
    std::error_code missing;
    if (const auto bytes = fs::file_size(journal, missing); missing || bytes == 0) continue;
    return Error{
        fmt::format("{}: another program is writing it, or was stopped while it did: {} is there; close that "
                    "program, or name another output",
                    claim.output.string(), journal.string())};
  }
  return Done{};
}

/// First column of the first row, as text; empty if there is none.
Result<std::string, SqlError> first_text(SqliteReader& reader, const std::string& sql) {
  Result<SqliteQuery, SqlError> query = reader.prepare(sql);
  if (!query) return query.error();
  const Result<bool, SqlError> row = query->step();
  if (!row) return row.error();
  return *row ? query->text(0).value_or("") : "";
}

/// The tables of a kind of database, and the place of its mark.
struct DatabaseRules {
  const char* name;
  const char* own_tables;
  const char* marked_table;  ///< a file of another program has none, or no row for the query
  std::string sql;           ///< finds the mark, or the description that has it
  bool in_description;
};

DatabaseRules rules_of(OutputKind kind) {
  if (kind == OutputKind::mbtiles) {
    return {"MBTiles file", kMbtilesTables, "metadata",
            fmt::format("SELECT value FROM metadata WHERE name = '{}'", kCutKeyField), false};
  }
  return {"GeoPackage", kGpkgTables, kTileSetTable,
          fmt::format("SELECT value FROM {} WHERE key = '{}'", kTileSetTable, kTileSetKey), true};
}

Status check_database(const OutputClaim& claim, const fs::path& there, const DatabaseRules& rules) {
  const auto unreadable = [&](const SqlError& error) {
    return stays(claim, fmt::format("is no {} that can be read ({})", rules.name, error.message));
  };
  Result<SqliteReader, SqlError> reader = SqliteReader::open(there, kMaxTileSetJsonBytes);
  if (!reader) return unreadable(reader.error());
  const Result<bool, SqlError> cache = reader->has_table(kCacheTable);
  if (!cache) return unreadable(cache.error());
  if (*cache) return stays(claim, "is a cache of tiles that `preload`, `view` or `merge` filled");
  const Result<std::string, SqlError> foreign = first_text(*reader, fmt::format(kForeignTable, rules.own_tables));
  if (!foreign) return unreadable(foreign.error());
  if (!foreign->empty()) {
    return stays(claim, fmt::format("is a database with the table \"{}\", which is no part of a tile set", *foreign));
  }
  const Result<bool, SqlError> described = reader->has_table(rules.marked_table);
  const Error others = stays(claim, "is a database that another program wrote");
  if (!described || !*described) return others;
  const auto text = first_text(*reader, rules.sql);
  if (!text) return unreadable(text.error());
  if (text->empty()) return others;
  // Earlier versions of `cut` wrote the table without a mark.
  return check_mark(claim, rules.in_description ? read_cut_key(*text).value_or("") : *text);
}

Status check_archive(const OutputClaim& claim, const fs::path& there) {
  const auto metadata = read_pmtiles_metadata(there);
  if (!metadata) return stays(claim, fmt::format("cannot be read as PMTiles ({})", metadata.error().message));
  const auto mark = read_cut_key(*metadata);
  if (!mark) return stays(claim, "is an archive that another program wrote");
  return check_mark(claim, *mark);
}

Status check_file(const OutputClaim& claim, const fs::path& there) {
  const OutputKind kind = output_kind(claim.output);
  const std::string ending = claim.output.extension().string();
  std::error_code failed;
  if (fs::is_directory(there, failed)) {
    return Error{fmt::format("{}: is a folder; name a file, or a folder that does not end in {}", claim.output.string(),
                             ending)};
  }
  if (!fs::is_regular_file(there, failed)) return stays(claim, "is a device, pipe or socket");
  if (Status quiet = check_journals(claim); !quiet) return quiet;
  if (fs::file_size(there, failed) == 0) return Done{};
  if (kind == OutputKind::pmtiles) return check_archive(claim, there);
  const DatabaseRules rules = rules_of(kind);
  if (failed || !is_sqlite_file(there)) {
    return stays(claim, fmt::format("is no {}, though its name ends in {}", rules.name, ending));
  }
  return check_database(claim, there, rules);
}

/// True for files and folders that `cut` and `convert` write; folders of tiles are named by level.
bool is_own_entry(const fs::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  if (name == kTileSetFile) return true;
  std::error_code failed;
  const bool level = name.find_first_not_of("0123456789") == std::string::npos;
  return entry.is_directory(failed) && (level || name == kSqueezedFolder);
}

Status check_folder(const OutputClaim& claim, const fs::path& there) {
  std::error_code failed;
  if (!fs::is_directory(there, failed)) {
    return Error{fmt::format("{}: is a file; name one that ends in .gpkg, .mbtiles or .pmtiles, or a folder",
                             claim.output.string())};
  }
  if (fs::is_empty(there, failed)) return Done{};
  const auto description = read_file(there / kTileSetFile, kMaxTileSetJsonBytes);
  const std::optional<std::string> mark = description ? read_cut_key(as_text(*description)) : std::nullopt;
  if (!mark) {
    return stays(
        claim, fmt::format("is a folder with other things in it (no {} that `cut` or `convert` wrote)", kTileSetFile));
  }
  for (fs::directory_iterator entry(there, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (is_own_entry(*entry)) continue;
    return stays(claim, fmt::format("is a folder with \"{}\" in it, which is no part of a tile set",
                                    entry->path().filename().string()));
  }
  if (failed) return stays(claim, "is a folder that cannot be read");
  return check_mark(claim, *mark);
}

}  // namespace

Status may_replace(const OutputClaim& claim, const fs::path& there) {
  const bool folder = output_kind(claim.output) == OutputKind::folder;
  std::error_code failed;
  if (!fs::exists(there, failed)) return folder ? Status(Done{}) : check_journals(claim);
  if (Status apart = check_inputs(claim, there); !apart) return apart;
  return folder ? check_folder(claim, there) : check_file(claim, there);
}

}  // namespace terrella
