#include "streaming/remote/remote_tile_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

#include "streaming/remote/tile_set_time.h"
#include "streaming/remote/web_address.h"
#include "streaming/sets/gpkg_schema.h"

namespace terrella {
namespace {

TileId shifted(const RemoteTileSet& set, const TileId& id) {
  const auto level = static_cast<std::size_t>(id.level);
  if (level >= set.shifts.size()) return id;
  const TileShift& shift = set.shifts[level];
  TileId moved{id.level, id.x + shift.columns, id.y + shift.rows};
  if (shift.turn_columns > 0) moved.x = (moved.x % shift.turn_columns + shift.turn_columns) % shift.turn_columns;
  return moved;
}

std::string level_name(const RemoteTileSet& set, int level) {
  const auto index = static_cast<std::size_t>(level);
  return index < set.level_names.size() ? percent_encode(set.level_names[index]) : std::to_string(level);
}

/// A number without exponent, 1e-12° or 1 µm exact. Some servers read no exponents.
std::string plain_number(double number, bool is_degrees) {
  std::string text = fmt::format("{:.{}f}", number, is_degrees ? 12 : 6);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string bbox_of(const RemoteTileSet& set, const TileId& id) {
  const TileGrid& grid = set.info.grid;
  const TileBounds bounds = tile_bounds(grid, id);
  const GridUnits units = units_of(grid.projection, set.info.square);
  const bool degrees = units.per_deg < 360.0;
  const auto text = [&](double number) { return plain_number(number, degrees); };
  const std::string west = text(units.x(bounds.west_deg)), east = text(units.x(bounds.east_deg));
  const std::string south = text(units.y(bounds.south_deg)), north = text(units.y(bounds.north_deg));
  if (set.northing_first) return fmt::format("{},{},{},{}", south, west, north, east);
  return fmt::format("{},{},{},{}", west, south, east, north);
}

std::string quadkey_of(const TileId& id, int level) {
  std::string key;
  for (int bit = level - 1; bit >= 0; --bit) {
    key += static_cast<char>('0' + static_cast<int>((id.x >> bit) & 1) + 2 * static_cast<int>((id.y >> bit) & 1));
  }
  return key;
}

/// Row counted from the south, among the rows that the server has.
std::int64_t row_from_south(const RemoteTileSet& set, const TileId& id) {
  const auto level = static_cast<std::size_t>(id.level);
  const std::int64_t all = level < set.shifts.size() ? set.shifts[level].south_rows : 0;
  return all > 0 ? all - 1 - shifted(set, id).y : rows(set.info.grid, id.level) - 1 - id.y;
}

std::string value_of(std::string_view name, const RemoteTileSet& set, const TileId& id) {
  if (name == "z") return level_name(set, id.level);
  if (name == "-y") return std::to_string(row_from_south(set, id));
  if (name == "s") return set.subdomains.empty() ? "" : set.subdomains[TileIdHash{}(id) % set.subdomains.size()];
  if (name == "bbox") return bbox_of(set, id);
  if (is_time_placeholder(name)) return time_in_url(set.info, name);
  const TileId moved = shifted(set, id);
  if (name == "q") return quadkey_of(moved, id.level);
  return std::to_string(name == "x" || name == "col" ? moved.x : moved.y);
}

bool is_secret(std::string_view parameter) {
  const std::string name = lower_case(parameter);
  constexpr std::string_view kParts[] = {"token", "signature", "secret", "passw", "credential"};
  return name.ends_with("key") || name == "sig" || name == "auth" ||
         std::ranges::any_of(kParts, [&](std::string_view part) { return name.find(part) != std::string::npos; });
}

}  // namespace

Url tile_url(const RemoteTileSet& set, const TileId& id) {
  assert(id.level >= 0 && id.level <= kMaxTileLevel);
  std::string url;
  std::string_view rest = set.url.with_secrets();
  for (std::size_t at = rest.find('{'); at != std::string_view::npos; at = rest.find('{')) {
    const std::size_t end = std::min(rest.find('}', at), rest.size() - 1);
    url += rest.substr(0, at);
    url += value_of(rest.substr(at + 1, end - at - 1), set, id);
    rest.remove_prefix(end + 1);
  }
  return url.append(rest);
}

std::string without_secrets(const Url& whole) {
  const std::string_view url = std::string_view(whole.with_secrets()).substr(0, whole.with_secrets().find('#'));
  std::string kept = whole.without_query();
  std::size_t at = url.find('?');
  while (at != std::string_view::npos) {
    const std::size_t next = url.find_first_of("&;", at + 1);
    const std::string_view parameter = url.substr(at, next == std::string_view::npos ? next : next - at);
    const std::size_t value = parameter.find('=');
    const std::string_view name = parameter.substr(1, value == std::string_view::npos ? value : value - 1);
    kept += is_secret(name) ? parameter.substr(0, value) : parameter;
    at = next;
  }
  return kept;
}

std::string source_key(const RemoteTileSet& set) {
  nlohmann::ordered_json key;
  key["url"] = without_secrets(url_at_its_time(set));
  key["subdomains"] = set.subdomains;
  key["levels"] = set.level_names;
  auto& shifts = key["shifts"] = nlohmann::ordered_json::array();
  for (const TileShift& shift : set.shifts) {
    shifts.push_back({shift.columns, shift.rows, shift.turn_columns});
    if (shift.south_rows != 0) shifts.back().push_back(shift.south_rows);
  }
  return key.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace terrella
