#include "apps/open_scene/scene_numbers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "apps/open_scene/open_imagery.h"
#include "apps/process/console.h"
#include "base/number.h"
#include "geo/body.h"
#include "streaming/numbers/colour_table.h"
#include "streaming/numbers/sample_tiles.h"
#include "streaming/numbers/slope_tiles.h"

namespace terrella {
namespace {

constexpr const char* kDefaultMap = "viridis";

/// A named map, and the value in its middle.
struct NamedMap {
  ColorMap colors;
  std::optional<double> center;
};

std::optional<NamedMap> named_map(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const std::string name = text.substr(0, colon);
  const auto colors = named_color_map(name);
  if (!colors) return {};
  NamedMap map{.colors = *colors, .center = {}};
  const bool has_middle = name == "terrain" || name == "diverging";
  if (has_middle) map.center = 0.0;
  if (colon == std::string::npos) return map;
  map.center = read_number(std::string_view(text).substr(colon + 1));
  return has_middle && map.center ? std::optional(map) : std::nullopt;
}

Rgba8 rgba(const TableColour& colour) { return {colour[0], colour[1], colour[2], colour[3]}; }

/// Stops of a table. Percentages alone are positions within the stretch; beside values they are parts of the range.
ColorMap map_of(const ColourTable& table, const NumberStatistics& statistics) {
  ColorMap map;
  map.discrete = table.discrete;
  map.by_value = !std::ranges::all_of(table.entries, &ColourTable::Entry::percent);
  for (const ColourTable::Entry& entry : table.entries) {
    const double share = entry.at / 100.0;
    const double at = !entry.percent ? entry.at
                      : map.by_value ? statistics.min + share * (statistics.max - statistics.min)
                                     : std::clamp(share, 0.0, 1.0);
    map.stops.push_back({.at = at, .color = rgba(entry.colour)});
  }
  std::ranges::stable_sort(map.stops, {}, &ColorStop::at);
  if (!table.other) return map;
  // Two stops at one place make a step to the colour of values beyond.
  map.stops.insert(map.stops.begin(), {.at = map.stops.front().at, .color = rgba(*table.other)});
  map.stops.push_back({.at = map.stops.back().at, .color = rgba(*table.other)});
  return map;
}

/// From the first to the last stop, a little more if values beyond have a colour of their own.
Stretch stretch_of(const ColorMap& map, bool beyond) {
  Stretch range{.low = map.stops.front().at, .high = map.stops.back().at};
  if (!(range.low < range.high)) range = {.low = range.low - 0.5, .high = range.high + 0.5};
  const double more = beyond ? 0.01 * (range.high - range.low) : 0.0;
  return {.low = range.low - more, .high = range.high + more};
}

Error wrong_for_pictures(const std::string& name) {
  return Error{fmt::format(
      "{}: its tiles are pictures, and --colormap, --stretch, --nodata, --band, --bands, --slope and --aspect are for "
      "rasters and sets of numbers; leave them out",
      name)};
}

/// The ellipsoid of a set on a body, or without one, of the body that the set states.
Ellipsoid figure_of(const TileSetInfo& info, const std::optional<Body>& on) {
  if (on) return on->ellipsoid;
  const auto body = info.body.empty() ? Result<Body>(earth()) : parse_body(info.body);
  return body ? body->ellipsoid : earth().ellipsoid;
}

/// Facts about the numbers and the grid of a set.
std::vector<std::string> facts_of(const TileSetInfo& info) {
  const NumberInfo& numbers = *info.numbers;
  const GeoRect& b = info.grid.bounds;
  const double pixel_deg = tile_span_deg(info.grid, info.grid.max_level) / info.grid.tile_px;
  const double radius_m = figure_of(info, {}).a_m();
  std::vector<std::string> lines;
  if (numbers.nodata) lines.push_back(fmt::format("No data: {:.9g}", *numbers.nodata));
  if (numbers.scale != 1.0 || numbers.offset != 0.0) {
    lines.push_back(fmt::format("Value = number * {:.9g} + {:.9g}", numbers.scale, numbers.offset));
  }
  lines.push_back(fmt::format("System: longitude and {} latitude{}",
                              info.grid.latitude == LatitudeKind::centric ? "planetocentric" : "geodetic",
                              info.square ? ", made of " + one_line(info.square->crs).substr(0, 60) : std::string()));
  lines.push_back(fmt::format("Bounds: {:.6g} to {:.6g}° E, {:.6g} to {:.6g}° N", b.west.deg(), b.east.deg(),
                              b.south.deg(), b.north.deg()));
  lines.push_back(fmt::format("Pixels: {:.6g}° ({:.6g} m)", pixel_deg, pixel_deg * M_PI / 180.0 * radius_m));
  return lines;
}

/// All directions, each in a colour of its own.
void round_the_compass(NumberOptions& options) {
  if (options.stretch.empty()) options.stretch = {{.kind = StretchRule::Kind::range, .low = 0.0, .high = 360.0}};
  if (options.colormap.empty()) options.colormap = "aspect";
}

/// Needs of a look that only the values can tell.
bool needs_statistics(const NumberOptions& options) {
  const bool file = !options.colormap.empty() && !named_map(options.colormap);
  return file || options.stretch.empty() || options.stretch.front().kind != StretchRule::Kind::range;
}

}  // namespace

Status check_colormap(const std::string& text) {
  std::error_code ignored;
  if (named_map(text) || std::filesystem::exists(text, ignored)) return Done{};
  return Error{fmt::format("{} is neither one of {}, aspect nor a file; :CENTRE goes with terrain and diverging",
                           in_quotes(text), fmt::join(color_map_names(), ", "))};
}

Result<NumberLook> look_of(const std::string& colormap, const Stretch& stretch, bool stretched,
                           const NumberStatistics& statistics) {
  NumberLook look{.low = stretch.low, .high = stretch.high, .center = {}, .colors = {}};
  if (const auto named = named_map(colormap.empty() ? kDefaultMap : colormap)) {
    look.colors = named->colors;
    if (named->center && *named->center > look.low && *named->center < look.high) look.center = named->center;
    if (named->center && colormap.find(':') != std::string::npos) look.center = named->center;
    return look;
  }
  const auto table = read_colour_table(colormap);
  if (!table) return table.error();
  look.colors = map_of(*table, statistics);
  if (look.colors.by_value && !stretched) {
    const Stretch whole = stretch_of(look.colors, table->other.has_value());
    look.low = whole.low;
    look.high = whole.high;
  }
  if (table->nodata && (*table->nodata)[3] != 0) {
    print_message("terrella: {}: \"nv\" has a colour, and places without data stay transparent\n", colormap);
  }
  return look;
}

Result<ImageryLayer> layer_of(std::shared_ptr<TileSource> tiles, const NumberOptions& options, const std::string& name,
                              bool wants_statistics) {
  ImageryLayer layer{.tiles = std::move(tiles), .look = {}, .numbers = {}};
  const auto& info = layer.tiles->info().numbers;
  if (!info) return layer;
  NumberFacts facts{.colormap = options.colormap.empty() ? kDefaultMap : options.colormap,
                    .unit = info->unit,
                    .quantity = info->quantity,
                    .lines = facts_of(layer.tiles->info()),
                    .statistics = {}};
  const bool needed = needs_statistics(options);
  if (needed || wants_statistics) {
    auto sampled = sample_tiles(*layer.tiles);
    if (!sampled && needed) return Error{fmt::format("{}: {}", name, sampled.error().message)};
    if (sampled) facts.statistics = *std::move(sampled);
  }
  const NumberStatistics known = facts.statistics.value_or(NumberStatistics{});
  const StretchRule rule = options.stretch.empty() ? StretchRule{} : options.stretch.front();
  auto look = look_of(options.colormap, stretch_by(rule, known), !options.stretch.empty(), known);
  if (!look) return look.error();
  layer.look.numbers = *std::move(look);
  layer.look.numbers->lit = options.lit;
  layer.look.numbers->contour_step = options.contours;
  layer.numbers = std::move(facts);
  return layer;
}

Result<ImageryLayer> open_layer(const SourceOptions& options) {
  auto tiles = open_any_tiles(options);
  if (!tiles) return tiles.error();
  const std::string name = options.address.redacted();
  const bool numbers = (*tiles)->info().numbers.has_value();
  if (!numbers && options.numbers.ask_for_numbers()) return wrong_for_pictures(name);
  if (numbers && options.numbers.stretch.size() > 1) {
    return Error{fmt::format("{}: one --stretch is enough for one band; three go with --bands", name)};
  }
  NumberOptions colored = options.numbers;
  if (const auto angle = colored.angle) {
    const Ellipsoid figure = figure_of((*tiles)->info(), options.body);
    tiles = slope_tiles(*std::move(tiles), *angle, figure, name);
    if (!tiles) return tiles.error();
    if (*angle == GroundAngle::aspect) round_the_compass(colored);
  }
  auto layer = layer_of(*std::move(tiles), colored, name, true);
  if (layer && layer->numbers) {
    print_message("terrella: {}: {}\n", name, look_text(*layer->numbers, *layer->look.numbers));
  }
  return layer;
}

std::string legend_title(const std::string& name, const NumberFacts& facts) {
  return one_line(facts.quantity.empty() ? name : facts.quantity);
}

std::string look_text(const NumberFacts& facts, const NumberLook& look) {
  const std::string unit = facts.unit.empty() ? "" : " " + one_line(facts.unit);
  return fmt::format("numbers in the colours of {}, from {:.6g} to {:.6g}{} (--colormap, --stretch)",
                     one_line(facts.colormap), look.low, look.high, unit);
}

}  // namespace terrella
