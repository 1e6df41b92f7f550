#include "streaming/sets/tms_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <pugixml.hpp>
#include <vector>

#include "streaming/sets/gpkg_schema.h"
#include "streaming/sets/tms_projected.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

constexpr int kMaxTileSets = 64;
// Tolerance of spans. Writers print a dozen digits; the tiles of level 24 then still lie right to a hundredth of a
// texel.
constexpr double kRelativeSlack = 1e-9;

struct TmsLevel {
  double span_deg = 0.0;
  std::string folder;
};

bool near(double a, double b, double relative) {
  return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b));
}

bool is_mercator(const pugi::xml_node& map) {
  const std::string srs = map.child_value("SRS");
  return srs.find("3857") != std::string::npos || srs.find("900913") != std::string::npos;
}

/// True for a system other than those of longitude and latitude and Web Mercator.
bool is_projected(const pugi::xml_node& map) {
  const std::string srs = map.child_value("SRS");
  return !is_mercator(map) && srs != "EPSG:4326" && srs != "OGC:CRS84" && srs != "CRS:84";
}

std::optional<std::string> refuse_reference_system(const pugi::xml_node& map) {
  const std::string srs = map.child_value("SRS");
  const std::string profile = map.child("TileSets").attribute("profile").value();
  if (!is_mercator(map) && profile.find("mercator") != std::string::npos) {
    return fmt::format("its <SRS> is {} and its profile \"{}\", which do not go together", srs, profile);
  }
  return std::nullopt;
}

/// Bounds in metres, or in degrees as gdal2tiles writes them.
GeoRect mercator_bounds(const pugi::xml_node& map) {
  constexpr double kMostDegrees = 360.0;
  const pugi::xml_node box = map.child("BoundingBox");
  const std::array sides = {tms_number(box, "minx"), tms_number(box, "miny"), tms_number(box, "maxx"),
                            tms_number(box, "maxy")};
  if (!std::ranges::all_of(sides, [](double side) { return std::isfinite(side); })) return {};
  const bool degrees = std::ranges::all_of(sides, [](double side) { return std::abs(side) <= kMostDegrees; });
  const auto lon = [&](double side) {
    return Angle::degrees(std::clamp(degrees ? side : side / kMercatorDegree_m, -180.0, 180.0));
  };
  const auto lat = [&](double side) {
    const double latitude = degrees ? side : latitude_of_mercator_row_deg(side / kMercatorDegree_m);
    return Angle::degrees(std::clamp(latitude, -90.0, 90.0));
  };
  return {.west = lon(sides[0]), .south = lat(sides[1]), .east = lon(sides[2]), .north = lat(sides[3])};
}

GeoRect read_bounds(const pugi::xml_node& map) {
  if (is_mercator(map)) return mercator_bounds(map);
  const pugi::xml_node box = map.child("BoundingBox");
  const auto side = [&](const char* name, double limit, double otherwise) {
    const double value = tms_number(box, name);
    return Angle::degrees(std::isfinite(value) ? std::clamp(value, -limit, limit) : otherwise);
  };
  return {.west = side("minx", 180.0, -180.0),
          .south = side("miny", 90.0, -90.0),
          .east = side("maxx", 180.0, 180.0),
          .north = side("maxy", 90.0, 90.0)};
}

/// True for a folder name that stays inside the tile set.
bool is_safe_folder(const std::string& name) {
  return !name.empty() && name.size() <= 64 && name.find('/') == std::string::npos && name != "." && name != "..";
}

Result<std::vector<TmsLevel>> read_levels(const pugi::xml_node& sets, double tile_units, bool must_halve,
                                          const std::string& where) {
  std::vector<TmsLevel> levels;
  for (const pugi::xml_node set : sets.children("TileSet")) {
    if (levels.size() == kMaxTileSets) return Error{fmt::format("{}: more than {} <TileSet>s", where, kMaxTileSets)};
    TmsLevel level{tms_number(set, "units-per-pixel") * tile_units, set.attribute("href").value()};
    if (const auto slash = level.folder.find_last_of('/'); slash != std::string::npos) level.folder.erase(0, slash + 1);
    if (!(level.span_deg > 0.0 && std::isfinite(level.span_deg))) {
      return Error{fmt::format("{}: <TileSet href=\"{}\"> has no positive units-per-pixel", where, level.folder)};
    }
    if (!is_safe_folder(level.folder)) return Error{where + ": the href of a <TileSet> is not the name of a folder"};
    levels.push_back(std::move(level));
  }
  if (levels.empty()) return Error{where + ": no <TileSet>, so it has no levels"};
  std::sort(levels.begin(), levels.end(), [](const TmsLevel& a, const TmsLevel& b) { return a.span_deg > b.span_deg; });
  for (std::size_t i = 1; must_halve && i < levels.size(); ++i) {
    if (!near(levels[i - 1].span_deg, 2.0 * levels[i].span_deg, 1e-6)) {
      return Error{fmt::format("{}: the tile of level \"{}\" spans {}°, that of \"{}\" {}°: levels must halve", where,
                               levels[i - 1].folder, levels[i - 1].span_deg, levels[i].folder, levels[i].span_deg)};
    }
  }
  return levels;
}

/// True if a whole number of tiles covers 180°. Only then do rows from -90° meet the rows of a TileGrid, which begin at
/// +90°.
bool divides_half_turn(double span_deg) {
  const double rows = 180.0 / span_deg;
  return rows > 0.5 && near(rows, std::round(rows), kRelativeSlack);
}

/// Assigns levels. The level is the number of halvings of 360°.
Status assign_mercator_levels(const std::vector<TmsLevel>& levels, TmsDescription& tms, const std::string& where) {
  TileGrid& grid = tms.info.grid;
  grid.root_span_deg = 360.0;
  const double steps = std::log2(360.0 / levels.front().span_deg);
  if (!(std::abs(steps - std::round(steps)) < 1e-6 && steps > -0.5 && steps < kMaxTileLevel + 0.5)) {
    return Error{fmt::format("{}: a tile of \"{}\" spans {}° in Web Mercator, it must be 360° halved some times", where,
                             levels.front().folder, levels.front().span_deg)};
  }
  grid.min_level = static_cast<int>(std::lround(steps));
  grid.max_level = grid.min_level + static_cast<int>(levels.size()) - 1;
  for (std::size_t i = 0; i < levels.size(); ++i) tms.folder[grid.min_level + static_cast<int>(i)] = levels[i].folder;
  return Done{};
}

/// Gives each folder its level in a grid. The root tile spans 180 · 2^n degrees or, for other spans, is the coarsest
/// tile.
Status assign_levels(std::vector<TmsLevel> levels, TmsDescription& tms, const std::string& where) {
  if (tms.info.grid.projection == Projection::web_mercator) return assign_mercator_levels(levels, tms, where);
  std::erase_if(levels, [](const TmsLevel& level) { return !divides_half_turn(level.span_deg); });
  if (levels.empty())
    return Error{where + ": no level's tiles divide 180°, so its rows cannot be counted from the north"};
  const double steps = std::log2(180.0 / levels.front().span_deg);
  const bool halves_180 = std::abs(steps - std::round(steps)) < 1e-6 && steps > -0.5;
  TileGrid& grid = tms.info.grid;
  grid.root_span_deg = halves_180 ? 180.0 : levels.front().span_deg;
  grid.min_level = halves_180 ? static_cast<int>(std::lround(steps)) : 0;
  grid.max_level = grid.min_level + static_cast<int>(levels.size()) - 1;
  for (std::size_t i = 0; i < levels.size(); ++i) tms.folder[grid.min_level + static_cast<int>(i)] = levels[i].folder;
  return Done{};
}

std::optional<ImageFormat> format_of_extension(std::string_view extension) {
  if (extension == "jpeg") return ImageFormat::jpeg;
  const auto* const found = std::ranges::find(kImageFormatNames, extension);
  if (found == kImageFormatNames.end()) return std::nullopt;
  return static_cast<ImageFormat>(found - kImageFormatNames.begin());
}

/// Completes the description of a set in a coordinate system of its own.
Result<TmsDescription> projected_tms_of(const pugi::xml_node& map, TmsDescription tms, const std::string& where) {
  const auto levels = read_levels(map.child("TileSets"), 1.0, false, where);
  if (!levels) return levels.error();
  std::vector<TmsUnits> units;
  units.reserve(levels->size());
  for (const TmsLevel& level : *levels) {
    tms.folder[static_cast<int>(units.size())] = level.folder;
    units.push_back({level.span_deg, level.folder});
  }
  if (Status placed = place_tms_levels(map, units, tms.info); !placed) {
    return Error{fmt::format("{}: its <SRS> \"{}\": {}", where, std::string(map.child_value("SRS")).substr(0, 100),
                             placed.error().message)};
  }
  return tms;
}

}  // namespace

Result<TmsDescription> parse_tms_xml(std::string_view text, const std::string& where) {
  if (text.size() > kMaxTmsXmlBytes) return Error{fmt::format("{}: longer than {} bytes", where, kMaxTmsXmlBytes)};
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed) return Error{fmt::format("{}: not XML at byte {}: {}", where, parsed.offset, parsed.description())};
  const pugi::xml_node map = document.child("TileMap");
  if (!map) return Error{where + ": no <TileMap>, so it is not the description of a TMS"};
  if (const auto refused = refuse_reference_system(map)) return Error{where + ": " + *refused};

  TmsDescription tms;
  const pugi::xml_node tile = map.child("TileFormat");
  const double width = tms_number(tile, "width");
  if (!(width >= kMinTilePx && width <= kMaxTilePx) || width != tms_number(tile, "height") ||
      width != std::floor(width)) {
    return Error{fmt::format("{}: <TileFormat> must have a width in [{}, {}] and a height that equals it", where,
                             kMinTilePx, kMaxTilePx)};
  }
  tms.extension = tile.attribute("extension").value();
  const auto format = format_of_extension(tms.extension);
  if (!format) {
    return Error{fmt::format("{}: tiles are \"{}\" files; jpg, png and webp can be read", where, tms.extension)};
  }
  tms.info.name = map.child_value("Title");
  tms.info.format = *format;
  tms.info.grid.tile_px = static_cast<int>(width);
  tms.info.grid.bounds = read_bounds(map);
  if (is_mercator(map)) tms.info.grid.projection = Projection::web_mercator;
  if (is_projected(map)) return projected_tms_of(map, std::move(tms), where);
  const double unit_deg = is_mercator(map) ? 1.0 / kMercatorDegree_m : 1.0;
  Result<std::vector<TmsLevel>> levels =
      read_levels(map.child("TileSets"), tms.info.grid.tile_px * unit_deg, true, where);
  if (!levels) return levels.error();
  if (Status assigned = assign_levels(*std::move(levels), tms, where); !assigned) return assigned.error();
  if (Status grid = check_grid(tms.info.grid, where); !grid) return grid.error();
  return tms;
}

}  // namespace terrella
