#include "streaming/remote/remote_pmtiles.h"

#include <fmt/format.h>

#include <algorithm>

#include "streaming/pmtiles/pmtiles_set.h"
#include "streaming/remote/url_template.h"
#include "streaming/remote/web_address.h"

namespace terrella {
namespace {

Status narrow_levels(TileGrid& grid, const RemoteOptions& options, const std::string& where) {
  const int first = std::max(options.min_level.value_or(grid.min_level), grid.min_level);
  const int last = std::min(options.max_level.value_or(grid.max_level), grid.max_level);
  if (first > last) {
    return Error{
        fmt::format("{}: it has levels {} to {}, none of those asked for", where, grid.min_level, grid.max_level)};
  }
  grid.min_level = first;
  grid.max_level = last;
  if (options.tile_px && *options.tile_px != grid.tile_px) {
    return Error{
        fmt::format("{}: its tiles have {} pixels, not the {} that were given", where, grid.tile_px, *options.tile_px)};
  }
  if (options.projection && *options.projection != Projection::web_mercator) {
    return Error{where + ": PMTiles are in Web Mercator, and --projection says otherwise; leave that out"};
  }
  return Done{};
}

}  // namespace

bool is_pmtiles_address(const Url& tile_set) {
  const auto address = parse_address(tile_set);
  if (!address || tile_set.with_secrets().find("{z}") != std::string::npos) return false;
  return (address->scheme == "http" || address->scheme == "https") && lower_case(address->path).ends_with(".pmtiles");
}

Result<RemoteTileSet> describe_remote_pmtiles(const Url& address, const RemoteOptions& options, RangeReader& reader) {
  const std::string where = address.redacted();
  if (Status fine = check_options(options, where); !fine) return fine.error();
  auto archive = describe_pmtiles([&](const ByteRange& range) { return reader.read(range); },
                                  [&] { return reader.version().file_bytes; }, where);
  if (!archive) return archive.error();
  RemoteTileSet set;
  set.info = std::move(archive->info);
  if (Status narrowed = narrow_levels(set.info.grid, options, where); !narrowed) return narrowed.error();
  const std::string_view text = address.with_secrets();
  set.url = encode_braces(text.substr(0, text.find('#')));
  set.file = TileFile{.index = std::move(archive->index), .version = reader.version()};
  apply_options(set, options);
  return set;
}

}  // namespace terrella
