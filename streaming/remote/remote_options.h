#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "tiles/tile_source.h"

namespace terrella {

/// What a person says about a remote set: on the command line, or in a JSON description. What is not said is decided by
/// the document that describes the set, else as noted.
struct RemoteOptions {
  std::string layer{};       ///< of a WMTS; empty: its only one
  std::string matrix_set{};  ///< of a WMTS; empty: the first of the layer's that a grid can describe
  std::string style{};       ///< of a WMTS; empty: its default
  std::string time{};        ///< of a WMTS's time dimension, ISO 8601; empty: its default

  std::optional<double> root_span_deg{};   ///< of a URL template; none: 180. Others: must agree with the document
  std::optional<int> tile_px{};            ///< of a URL template; none: 256. Others: must agree with the document
  std::optional<int> min_level{};          ///< none: 0
  std::optional<int> max_level{};          ///< required for a URL template
  std::optional<GeoRect> bounds{};         ///< none: the planet, or what the document says
  std::optional<Projection> projection{};  ///< web_mercator: what the tiles are in; others must agree with the document
  std::optional<LatitudeKind> latitude{};
  std::optional<ImageFormat> format{};  ///< none: by the ending of a URL template, else jpeg

  std::optional<ElevationInfo> elevation{};  ///< the tiles are heights, 16-bit PNGs; none: pictures

  std::optional<std::string> name{};
  std::optional<std::string> attribution{};
  std::optional<std::string> body{};      ///< preset name or "A,F"
  std::vector<std::string> subdomains{};  ///< for {s}; empty: a, b, c
  std::vector<std::string> headers{};     ///< "Name: value", for the documents and the tiles; may be secret
  std::optional<std::chrono::seconds> tile_life{};
  std::optional<std::chrono::seconds> absence_life{};
};

/// `said`, and where it says nothing, `otherwise`. Headers of both, those of `said` first. thread: any
[[nodiscard]] RemoteOptions merge(const RemoteOptions& said, const RemoteOptions& otherwise);

/// Fails if one of what is said and what a document says of its grid is Web Mercator and the other is not. thread: any
[[nodiscard]] Status check_projection(const TileGrid& grid, const RemoteOptions& options);

/// Checks what a set of options may hold apart from any set: headers, sub-domains, body. The error begins with `where`
/// and does not repeat a header's value. thread: any
[[nodiscard]] Status check_options(const RemoteOptions& options, const std::string& where);

}  // namespace terrella
