#include "streaming/cut/output_claim.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "streaming/cache/cache_schema.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/file_bytes.h"
#include "streaming/sets/geopackage_source.h"
#include "streaming/sets/tileset_json.h"
#include "streaming/sqlite_reader.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Finds a table that is neither in gpkg_schema.cpp nor SQLite's own.
constexpr const char* kForeignTable =
    "SELECT name FROM sqlite_master WHERE type IN ('table', 'view') AND name NOT LIKE 'sqlite\\_%' ESCAPE '\\' AND "
    "name "
    "NOT IN ('gpkg_spatial_ref_sys', 'gpkg_contents', 'gpkg_tile_matrix_set', 'gpkg_tile_matrix', 'gpkg_extensions', "
    "'gpkg_2d_gridded_coverage_ancillary', 'gpkg_2d_gridded_tile_ancillary', 'tiles', 'terrella_tileset', "
    "'terrella_squeezed_tiles') ORDER BY name";

/// Error about the existing output. `what` completes the sentence "OUT.gpkg: is …".
Error stays(const OutputClaim& claim, const std::string& what) {
  return Error{
      fmt::format("{}: {}; `cut` replaces only tile sets that it wrote itself: name another output, or move "
                  "this one away",
                  claim.output.string(), what)};
}

Status check_mark(const OutputClaim& claim, const std::string& mark) {
  if (mark == claim.mark || claim.force) return Done{};
  return Error{
      fmt::format("{}: is a tile set that was cut from other pictures; give ‹force› to "
                  "replace it, or name another output",
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
    return Error{fmt::format("{}: {} the picture {} that is to be cut; name another output", claim.output.string(),
                             same ? "is" : "holds", image.string())};
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

Status check_geopackage(const OutputClaim& claim, const fs::path& there) {
  const auto unreadable = [&](const SqlError& error) {
    return stays(claim, fmt::format("is a file that cannot be read as a GeoPackage ({})", error.message));
  };
  Result<SqliteReader, SqlError> reader = SqliteReader::open(there, kMaxTileSetJsonBytes);
  if (!reader) return unreadable(reader.error());
  const Result<bool, SqlError> cache = reader->has_table(kCacheTable);
  if (!cache) return unreadable(cache.error());
  if (*cache) return stays(claim, "is a cache of tiles that `preload`, `view` or `merge` filled");
  const Result<std::string, SqlError> foreign = first_text(*reader, kForeignTable);
  if (!foreign) return unreadable(foreign.error());
  if (!foreign->empty()) {
    return stays(claim, fmt::format("is a database with the table \"{}\", which `cut` did not write", *foreign));
  }
  const Result<bool, SqlError> described = reader->has_table(kTileSetTable);
  if (!described || !*described) return stays(claim, "is a database that another program wrote");
  const auto text =
      first_text(*reader, fmt::format("SELECT value FROM {} WHERE key = '{}'", kTileSetTable, kTileSetKey));
  if (!text) return unreadable(text.error());
  // Earlier versions of `cut` wrote the table without a mark.
  return check_mark(claim, read_cut_key(*text).value_or(""));
}

Status check_file(const OutputClaim& claim, const fs::path& there) {
  std::error_code failed;
  if (fs::is_directory(there, failed)) {
    return Error{
        fmt::format("{}: is a folder; name a file, or a folder that does not end in .gpkg", claim.output.string())};
  }
  if (!fs::is_regular_file(there, failed)) return stays(claim, "is a device, pipe or socket");
  if (Status quiet = check_journals(claim); !quiet) return quiet;
  if (fs::file_size(there, failed) == 0) return Done{};
  if (failed || !is_sqlite_file(there)) return stays(claim, "is no GeoPackage, though its name ends in .gpkg");
  return check_geopackage(claim, there);
}

/// True for files and folders that `cut` writes; folders of tiles are named by level.
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
    return Error{fmt::format("{}: is a file; name one that ends in .gpkg, or a folder", claim.output.string())};
  }
  if (fs::is_empty(there, failed)) return Done{};
  const auto description = read_file(there / kTileSetFile, kMaxTileSetJsonBytes);
  const std::optional<std::string> mark = description ? read_cut_key(as_text(*description)) : std::nullopt;
  if (!mark) return stays(claim, fmt::format("is a folder with other things in it (no {} by `cut`)", kTileSetFile));
  for (fs::directory_iterator entry(there, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (is_own_entry(*entry)) continue;
    return stays(claim, fmt::format("is a folder with \"{}\" in it, which `cut` did not write",
                                    entry->path().filename().string()));
  }
  if (failed) return stays(claim, "is a folder that cannot be read");
  return check_mark(claim, *mark);
}

}  // namespace

Status may_replace(const OutputClaim& claim, const fs::path& there) {
  const bool gpkg = is_gpkg_name(claim.output);
  std::error_code failed;
  if (!fs::exists(there, failed)) return gpkg ? check_journals(claim) : Status(Done{});
  if (Status apart = check_inputs(claim, there); !apart) return apart;
  return gpkg ? check_file(claim, there) : check_folder(claim, there);
}

}  // namespace terrella
