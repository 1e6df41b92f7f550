#include "streaming/sets/tms_projected.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "streaming/georeference/crs.h"
#include "streaming/georeference/crs_text.h"
#include "streaming/georeference/figure.h"
#include "streaming/sets/crs_levels.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

Result<std::vector<CrsLevel>> tms_levels(const pugi::xml_node& map, const std::vector<TmsUnits>& said, int tile_px) {
  const pugi::xml_node box = map.child("BoundingBox"), origin = map.child("Origin");
  const double west = tms_number(origin, "x"), south = tms_number(origin, "y");
  const double east = tms_number(box, "maxx"), north = tms_number(box, "maxy");
  for (const double side : {west, south, east, north}) {
    if (!(std::abs(side) < 1e12)) return Error{"its <Origin> or <BoundingBox> has no numbers"};
  }
  if (!(west < east && south < north)) return Error{"its <BoundingBox> ends before its <Origin>"};
  std::vector<CrsLevel> levels;
  levels.reserve(said.size());
  for (const TmsUnits& one : said) {
    const double span = one.unit_per_px * tile_px;
    const double columns = tiles_over(east - west, span), rows = tiles_over(north - south, span);
    if (!(span > 0.0 && columns <= kMaxTilesASide && rows <= kMaxTilesASide)) {
      return Error{fmt::format("<TileSet href=\"{}\"> has units-per-pixel of {}, which give too many tiles", one.folder,
                               one.unit_per_px)};
    }
    levels.push_back({.west = west,
                      .north = south + rows * span,
                      .unit_per_px = one.unit_per_px,
                      .columns = static_cast<std::int64_t>(columns),
                      .rows = static_cast<std::int64_t>(rows)});
  }
  return levels;
}

}  // namespace

double tms_number(const pugi::xml_node& node, const char* attribute) {
  const char* text = node.attribute(attribute).value();
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  return end != text && *end == '\0' && std::isfinite(value) ? value : std::nan("");
}

Status place_tms_levels(const pugi::xml_node& map, const std::vector<TmsUnits>& levels, TileSetInfo& info) {
  if (levels.size() > kMaxTileLevel + 1) {
    return Error{fmt::format("it has {} levels, at most {} are read", levels.size(), kMaxTileLevel + 1)};
  }
  const Result<std::string> text = stated_crs(map.child_value("SRS"));
  if (!text) return text.error();
  const Result<Crs> crs = Crs::open(*text);
  if (!crs) return Error{fmt::format("{} ({})", crs.error().message, text->substr(0, 100))};
  auto placed = tms_levels(map, levels, info.grid.tile_px);
  if (!placed) return placed.error();
  info.body = body_name(crs->facts());
  place_own_levels(*text, *std::move(placed), info);
  return Done{};
}

}  // namespace terrella
