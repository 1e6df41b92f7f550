#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/coordinates.h"
#include "streaming/preload/tile_plan.h"
#include "tiles/tile_source.h"

namespace terrella {

/// First and last level of a range, both included.
struct LevelRange {
  int first = 0;
  int last = 0;
};

/// Levels and parts of a planet that a command works on.
struct PreloadArea {
  std::optional<LevelRange> levels;
  std::vector<GeoRect> boxes;
  std::vector<std::string> polygons;  ///< GeoJSON files
  std::vector<std::string> routes;    ///< GeoJSON files
  double radius_m = 0.0;              ///< distance from the routes; 0: not given
  [[nodiscard]] bool is_planet() const { return boxes.empty() && polygons.empty() && routes.empty(); }
};

/// Adds --levels, --bbox, --polygon, --route and --radius; `area` must outlive the parse. thread: main
void add_area_options(CLI::App& app, PreloadArea& area);
/// Checks combinations of these options; an error means wrong usage.
[[nodiscard]] Status check_area(const PreloadArea& area);

/// The levels of a set that the area asks for. `name` of the set begins the error.
[[nodiscard]] Result<LevelRange> levels_of(const PreloadArea& area, const TileGrid& grid, const std::string& name);
/// The tiles of a set that touch the area, or lie inside it. Reads the GeoJSON files; an error names the file, or the
/// set. thread: main
[[nodiscard]] Result<std::shared_ptr<const TilePlan>> plan_area(const PreloadArea& area, const TileSetInfo& info,
                                                                const std::string& name,
                                                                TileRule rule = TileRule::overlapping);

}  // namespace terrella
