#include <fmt/format.h>

#include "streaming/cache/cache_report.h"
#include "streaming/cache/cache_schema.h"
#include "streaming/file_bytes.h"
#include "streaming/other_formats.h"
#include "streaming/pmtiles/pmtiles_set.h"
#include "streaming/sets/directory_source.h"
#include "streaming/sets/geopackage_source.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/warp/web_mercator.h"
#include "tiles/tile_source.h"

namespace terrella {

Result<std::unique_ptr<TileSource>> open_stored_tile_set(const std::filesystem::path& path, bool geodetic_mbtiles) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    return Error{fmt::format("{}: there is no such file or directory", path.string())};
  }
  if (error) return Error{fmt::format("{}: {}", path.string(), error.message())};
  if (std::filesystem::is_directory(status)) return open_directory(path);
  if (read_cache_source(path).starts_with(kRangesKey)) {
    return Error{fmt::format("{0}: keeps parts of a TIFF on a server; show that TIFF with ‹cache› {0} and ‹offline›",
                             path.string())};
  }
  if (is_sqlite_file(path)) return open_geopackage(path, geodetic_mbtiles);
  const auto head = read_head(path, kFormatHeadBytes);
  if (!head) return Error{head.error().message};
  if (head->empty()) return Error{fmt::format("{}: the file is empty, so it is not a tile set", path.string())};
  if (begins_as_pmtiles(*head)) return open_pmtiles(path);
  const std::string hint = convert_hint(path, as_text(*head));
  if (!hint.empty()) return Error{fmt::format("{}: {}", path.string(), hint)};
  return Error{
      fmt::format("{}: neither a picture nor a tile set. Accepted are pictures (JPEG, PNG, WebP, TIFF), a GeoPackage, "
                  "MBTiles, PMTiles, and a directory of tiles with tileset.json or tilemapresource.xml",
                  path.string())};
}

Result<std::unique_ptr<TileSource>> open_tile_set(const std::filesystem::path& path, bool geodetic_mbtiles) {
  auto stored = open_stored_tile_set(path, geodetic_mbtiles);
  if (!stored) return stored;
  return as_geodetic(*std::move(stored), path.string());
}

}  // namespace terrella
