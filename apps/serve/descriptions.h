#pragma once

#include <span>
#include <string>
#include <string_view>

#include "apps/serve/served_set.h"
#include "base/result.h"

// Documents about sets. Their addresses begin with `base`, for example "http://127.0.0.1:8080".
// thread: any, for all of this header
namespace terrella {

/// Address of a set's XYZ tiles with {z}, {x} and {y}.
[[nodiscard]] std::string tile_template(const ServedSet& set, std::string_view base);

/// Capabilities of a WMTS 1.0.0 that has the sets as layers, each in a matrix set of the same name. Leaves out sets
/// that cannot be in one. Fails with the reason if no set is left.
[[nodiscard]] Result<std::string> wmts_capabilities(std::span<const ServedSet> sets, std::string_view base);

/// TileJSON 3.0. Fails with the reason for sets that are not in Web Mercator of the Earth.
[[nodiscard]] Result<std::string> tile_json(const ServedSet& set, std::string_view base);

/// Exception of a WMTS, as XML.
[[nodiscard]] std::string ogc_exception(std::string_view code, std::string_view text);

/// A page with the addresses of all sets and pictures of their coarsest tiles. It refers to this server alone.
[[nodiscard]] std::string overview_page(std::span<const ServedSet> sets, std::string_view base);

/// Addresses of the server and of all sets as a JSON object on one line, for scripts.
[[nodiscard]] std::string addresses_json(std::span<const ServedSet> sets, std::string_view base, int port);

/// Media type of the set's tiles, and of a picture.
[[nodiscard]] const char* media_type(const TileSetInfo& info);
[[nodiscard]] const char* media_type(ImageFormat format);

}  // namespace terrella
