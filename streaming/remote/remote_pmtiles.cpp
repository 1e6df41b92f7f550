#include "streaming/remote/remote_pmtiles.h"

#include <fmt/format.h>

#include <algorithm>

#include "streaming/pmtiles/pmtiles_set.h"
#include "streaming/remote/url_template.h"
#include "streaming/remote/web_address.h"

namespace terrella {
namespace {

Status fit_archive(TileGrid& grid, const RemoteOptions& options) {
  if (Status left = narrow_levels(grid, options); !left) return left;
  if (Status same = check_tile_px(grid, options); !same) return same;
  if (options.projection && *options.projection != Projection::web_mercator) {
    return Error{"PMTiles are in Web Mercator, and ‹projection› says otherwise; leave that out"};
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
  if (Status adjusted = fit_archive(set.info.grid, options); !adjusted) {
    return Error{where + ": " + adjusted.error().message};
  }
  const std::string_view text = address.with_secrets();
  set.url = encode_braces(text.substr(0, text.find('#')));
  set.file = TileFile{.index = std::move(archive->index), .version = reader.version()};
  apply_options(set, options);
  return set;
}

}  // namespace terrella
