#include "streaming/remote/url_template.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "streaming/remote/bulk_terms.h"
#include "streaming/remote/stated_square.h"
#include "streaming/remote/tile_set_time.h"
#include "streaming/remote/web_address.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

constexpr const char* kPlaceholders = "{z} {x} {y} {-y} {s} {row} {col} {q} {bbox} {time}";

bool is_placeholder(std::string_view name) {
  return name == "z" || name == "x" || name == "y" || name == "-y" || name == "s" || name == "row" || name == "col" ||
         name == "q" || name == "bbox" || is_time_placeholder(name);
}

struct Scan {
  std::set<std::string, std::less<>> names;
  std::string fault;
};

Scan scan(std::string_view url) {
  Scan found;
  for (std::size_t at = url.find_first_of("{}"); at != std::string_view::npos; at = url.find_first_of("{}", at)) {
    const std::size_t end = url.find_first_of("{}", at + 1);
    if (url[at] == '}' || end == std::string_view::npos || url[end] == '{') {
      found.fault = "has a brace without its other half";
      return found;
    }
    const std::string_view name = url.substr(at + 1, end - at - 1);
    if (!is_placeholder(name)) {
      found.fault = fmt::format("has the unknown placeholder {{{}}}; known are {}", name, kPlaceholders);
      return found;
    }
    if (found.fault = fault_of_time_placeholder(name); !found.fault.empty()) return found;
    found.names.emplace(name);
    at = end + 1;
  }
  return found;
}

std::string fault_of_host(std::string_view url, bool is_file) {
  const std::size_t host = url.find("://") + 3;
  const std::string_view authority = url.substr(host, url.find_first_of("/?#", host) - host);
  if (authority.empty() && !is_file) return "is not an address: it has no host";
  for (const std::string& name : scan(authority).names) {
    if (name != "s") return fmt::format("has {{{}}} in its host, where only {{s}} may stand", name);
  }
  return {};
}

std::string fault_of_names(const Scan& found) {
  if (found.names.contains("q") || found.names.contains("bbox")) return {};
  if (!found.names.contains("z")) return "has no {z}, so its level cannot be asked for";
  if (!found.names.contains("x") && !found.names.contains("col")) return "has no {x}, so no column can be asked for";
  const auto rows = found.names.count("y") + found.names.count("row") + found.names.count("-y");
  if (rows == 0) return "has no {y} (or {-y}, rows from the south), so no row can be asked for";
  if (found.names.contains("-y") && rows > 1) return "has both {y} and {-y}; rows count from one end";
  return {};
}

std::string fault_of(const RemoteTileSet& set, bool files) {
  const std::string_view url = set.url.with_secrets();
  if (url.size() > kMaxUrlBytes) return fmt::format("is longer than {} bytes", kMaxUrlBytes);
  const auto is_printable = [](char c) { return static_cast<unsigned char>(c) > 0x20 && c != 0x7f; };
  if (!std::ranges::all_of(url, is_printable)) return "holds a space or a control character; write %20 for a space";
  const std::string scheme = has_scheme(url) ? lower_case(url.substr(0, url.find(':'))) : std::string();
  if (scheme != "http" && scheme != "https" && !(files && scheme == "file")) {
    return fmt::format("must begin with http:// or https://{}", files ? " or file://" : "");
  }
  const Scan found = scan(url);
  if (!found.fault.empty()) return found.fault;
  if (std::string fault = fault_of_host(url, scheme == "file"); !fault.empty()) return fault;
  if (std::string fault = fault_of_names(found); !fault.empty()) return fault;
  if (found.names.contains("s") && set.subdomains.empty()) return "has {s}, but there are no sub-domains";
  const auto address = parse_address(tile_url(set, {.level = set.info.grid.min_level}));
  if (!address) return "is not an address";
  return {};
}

/// True if a whole number of tiles covers 180°, so that rows can be counted from the south. This then holds for finer
/// levels too.
bool counts_from_south(const TileGrid& grid, int level) {
  const double tiles = 2.0 * top_row_deg(grid) / tile_span_deg(grid, level);
  return tiles > 0.75 && std::abs(tiles - std::round(tiles)) < 1e-9 * tiles;
}

/// Leaves out levels whose rows cannot be counted from the south, such as a single root tile: it would cover
/// -90°…270°.
Status fit_rows_from_south(TileGrid& grid, bool level_said, const std::string& where) {
  int first = grid.min_level;
  while (first <= grid.max_level && !counts_from_south(grid, first)) ++first;
  if (first == grid.min_level) return Done{};
  if (first <= grid.max_level && !level_said) {
    grid.min_level = first;
    return Done{};
  }
  return Error{
      fmt::format("{}: at level {} a tile spans {}°, which does not divide 180°, so rows cannot be counted "
                  "from the south; {}",
                  where, grid.min_level, tile_span_deg(grid, grid.min_level),
                  first <= grid.max_level ? fmt::format("begin at level {}", first)
                                          : std::string("use {y} if the rows count from the north"))};
}

ImageFormat format_of_ending(const std::string& url) {
  const std::string path = lower_case(url.substr(0, url.find('?')));
  if (path.ends_with(".webp")) return ImageFormat::webp;
  return path.ends_with(".png") ? ImageFormat::png : ImageFormat::jpeg;
}

/// Gives a set the grid of the options, in longitude and latitude or in Web Mercator.
Status place_in_degrees(const RemoteOptions& options, RemoteTileSet& set, const std::string& where) {
  if (!options.max_level) {
    return Error{where + ": it is not said how many levels it has; say ‹levels› 0-N (max_level in a description)"};
  }
  TileGrid& grid = set.info.grid;
  grid.projection = options.projection.value_or(grid.projection);
  grid.root_span_deg = options.root_span_deg.value_or(grid.projection == Projection::web_mercator ? 360.0 : 180.0);
  grid.tile_px = options.tile_px.value_or(256);
  grid.min_level = options.min_level.value_or(0);
  grid.max_level = *options.max_level;
  grid.bounds = options.bounds.value_or(GeoRect{});
  if (Status checked = check_grid(grid, where); !checked) return checked;
  if (set.url.with_secrets().find("{-y}") != std::string::npos) {
    const bool level_said = options.min_level.value_or(0) > 0;
    return fit_rows_from_south(grid, level_said, where);
  }
  return Done{};
}

}  // namespace

Status check_url_template(const RemoteTileSet& set, bool files, const std::string& where) {
  const std::string fault = fault_of(set, files);
  if (fault.empty()) return Done{};
  return Error{fmt::format("{}: the URL template {} {}", where, set.url.redacted(), fault)};
}

void apply_options(RemoteTileSet& set, const RemoteOptions& options) {
  TileSetInfo& info = set.info;
  info.name = options.name.value_or(info.name);
  info.attribution = options.attribution.value_or(info.attribution);
  info.body = options.body.value_or(info.body);
  info.grid.projection = options.projection.value_or(info.grid.projection);
  info.grid.latitude = options.latitude.value_or(info.grid.latitude);
  // Bounds in degrees say nothing about a projected square.
  if (!info.square) info.grid.bounds = options.bounds.value_or(info.grid.bounds);
  set.headers = options.headers;
  if (options.tile_life) set.tile_life = options.tile_life;
  if (options.missing_life) set.missing_life = options.missing_life;
  RemoteTileSet each = set;
  const std::size_t hosts = std::max<std::size_t>(1, set.subdomains.size());
  for (std::size_t i = 0; i < hosts && set.refuse_bulk.empty(); ++i) {
    if (!set.subdomains.empty()) each.subdomains = {set.subdomains[i]};
    set.refuse_bulk = bulk_refusal(tile_url(each, {.level = info.grid.min_level}));
  }
}

Result<RemoteTileSet> template_tile_set(const Url& url, const RemoteOptions& options, bool files,
                                        const std::string& where) {
  RemoteTileSet set;
  set.url = url;
  set.info.name = url.without_query();
  set.subdomains = options.subdomains;
  if (set.subdomains.empty() && url.with_secrets().find("{s}") != std::string::npos) set.subdomains = {"a", "b", "c"};
  if (Status checked = check_options(options, where); !checked) return checked.error();
  if (Status checked = check_url_template(set, files, where); !checked) return checked.error();
  if (Status timed = choose_template_time(set, options, where); !timed) return timed.error();
  if (options.square) {
    if (Status placed = place_on_stated_square(options, set); !placed) {
      return Error{where + ": " + placed.error().message};
    }
  } else if (Status placed = place_in_degrees(options, set, where); !placed) {
    return placed.error();
  }
  set.info.format = options.format.value_or(format_of_ending(url.with_secrets()));
  apply_options(set, options);
  return set;
}

}  // namespace terrella
