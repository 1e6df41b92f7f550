#include "streaming/remote/remote_tms.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "streaming/remote/stated_square.h"
#include "streaming/remote/url_template.h"
#include "streaming/remote/web_address.h"
#include "streaming/sets/tms_xml.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

/// Applies the user's options to the grid: levels, and the span of the root tile. gdal2tiles describes both of its
/// kinds with 180°, so a user may know better.
Status adjust(TileGrid& grid, const RemoteOptions& options) {
  if (grid.projection != Projection::projected) {
    grid.root_span_deg = options.root_span_deg.value_or(grid.root_span_deg);
  }
  if (Status left = narrow_levels(grid, options); !left) return left;
  return check_tile_px(grid, options);
}

/// A set in a coordinate system of its own.
Result<RemoteTileSet> projected_tms(TmsDescription tms, const Url& url, const RemoteOptions& options,
                                    const std::string& where) {
  RemoteTileSet set;
  set.url = url;
  set.info = std::move(tms.info);
  set.shifts = south_rows_of(set.info);
  set.level_names.reserve(tms.folder.size());
  for (auto& [level, name] : tms.folder) set.level_names.push_back(std::move(name));
  if (set.info.name.empty()) set.info.name = url.without_query();
  if (Status checked = check_options(options, where); !checked) return checked.error();
  if (Status checked = check_url_template(set, true, where); !checked) return checked.error();
  apply_options(set, options);
  return set;
}

}  // namespace

Result<RemoteTileSet> parse_remote_tms(std::string_view xml, const Url& address, const RemoteOptions& options,
                                       const std::string& where) {
  Result<TmsDescription> tms = parse_tms_xml(xml, where);
  if (!tms) return tms.error();
  if (Status same = check_projection(tms->info.grid, options); !same) {
    return Error{where + ": " + same.error().message};
  }
  if (Status adjusted = adjust(tms->info.grid, options); !adjusted) {
    return Error{where + ": " + adjusted.error().message};
  }
  const std::string_view text = address.with_secrets();
  const std::string plain = encode_braces(text.substr(0, text.find('#')));
  const std::size_t query = std::min(plain.find('?'), plain.size());
  const std::string folder = plain.substr(0, plain.rfind('/', query) + 1);

  const Url url = folder + "{z}/{x}/{-y}." + tms->extension + plain.substr(query);
  if (tms->info.square) return projected_tms(*std::move(tms), url, options, where);
  RemoteOptions rest = options;
  rest.root_span_deg = tms->info.grid.root_span_deg;
  rest.tile_px = tms->info.grid.tile_px;
  rest.min_level = tms->info.grid.min_level;
  rest.max_level = tms->info.grid.max_level;
  rest.format = tms->info.format;
  rest.projection = tms->info.grid.projection;
  if (options.projection) rest.projection = options.projection;
  if (!options.bounds) rest.bounds = tms->info.grid.bounds;
  if (!options.name && !tms->info.name.empty()) rest.name = tms->info.name;
  // Level 0 of a set with one root tile lies on no grid. The user did not ask for it.
  if (!options.min_level && rest.min_level == 0) rest.min_level.reset();
  Result<RemoteTileSet> set = template_tile_set(url, rest, true, where);
  if (!set) return set;
  set->level_names.resize(static_cast<std::size_t>(set->info.grid.max_level) + 1);
  for (const auto& [level, name] : tms->folder) {
    if (level <= set->info.grid.max_level) set->level_names[static_cast<std::size_t>(level)] = name;
  }
  return set;
}

}  // namespace terrella
