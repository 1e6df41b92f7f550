#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "streaming/georeference/georeference.h"
#include "tiles/tile_source.h"

namespace terrella {

/// The place of a URL template's tiles in a coordinate system of its own: `crs` and `extent`, or a matrix set.
struct StatedSquare {
  std::string crs{};                  ///< a code, WKT or a PROJ string
  std::optional<CrsBounds> extent{};  ///< area of the tiles, units of `crs`; tiles begin at its north-west corner
  /// Units in a pixel, by level; empty: level 0 is one tile over the longer side, and levels halve.
  std::vector<double> resolutions{};
  std::string matrix_set_json{};  ///< an OGC tile matrix set as JSON; empty: none
};

/// User's options for a remote set, from the command line or a JSON description. Defaults come from the document that
/// describes the set, else as noted.
struct RemoteOptions {
  std::string layer{};       ///< WMTS or WMS layers; empty: the only one
  std::string matrix_set{};  ///< WMTS matrix set; empty: the layer's first that fits a grid
  std::string style{};       ///< WMTS or WMS style; empty: its default
  std::string time{};        ///< time, ISO 8601; empty: the default of the WMTS or WMS, the newest of a URL template
  std::vector<std::string> times{};  ///< instants of a URL template, as TimeSteps::parse() reads them

  std::optional<double> root_span_deg{};  ///< for a URL template; none: 180. For others: must agree with the document
  std::optional<int> tile_px{};           ///< for a URL template; none: 256. For others: must agree with the document
  std::optional<int> min_level{};         ///< none: 0
  std::optional<int> max_level{};         ///< required for a URL template
  std::optional<GeoRect> bounds{};        ///< none: the planet, or the bounds of the document
  /// web_mercator: projection of the tiles. For others: must agree with the document.
  std::optional<Projection> projection{};
  std::optional<StatedSquare> square{};  ///< for a URL template; none: longitude and latitude, or Web Mercator
  std::optional<LatitudeKind> latitude{};
  std::optional<ImageFormat> format{};  ///< none: by the ending of a URL template, else jpeg

  std::optional<NumberInfo> numbers{};  ///< the tiles are heights, 16-bit PNGs; none: pictures

  std::optional<std::string> name{};
  std::optional<std::string> attribution{};
  std::optional<std::string> body{};      ///< preset name or "A,F"
  std::vector<std::string> subdomains{};  ///< for {s}; empty: a, b, c
  std::vector<std::string> headers{};     ///< "Name: value", for the documents and the tiles; may be secret
  std::optional<std::chrono::seconds> tile_life{};
  std::optional<std::chrono::seconds> missing_life{};
};

/// Merges options: `said` wins, `otherwise` fills the gaps. Headers of both are kept, those of `said` first.
/// thread: any
[[nodiscard]] RemoteOptions merge(const RemoteOptions& said, const RemoteOptions& otherwise);

/// Fails if only one of the options and the document's grid is Web Mercator. thread: any
[[nodiscard]] Status check_projection(const TileGrid& grid, const RemoteOptions& options);

/// Narrows the document's levels to the options'. Fails if none is left. thread: any
[[nodiscard]] Status narrow_levels(TileGrid& grid, const RemoteOptions& options);

/// Fails if the options give another tile size than the document's grid. thread: any
[[nodiscard]] Status check_tile_px(const TileGrid& grid, const RemoteOptions& options);

/// Checks options that can be checked without a set: headers, sub-domains, body. The error begins with `where` and does
/// not repeat a header's value. thread: any
[[nodiscard]] Status check_options(const RemoteOptions& options, const std::string& where);

}  // namespace terrella
