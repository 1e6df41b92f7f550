#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "apps/open_scene/options/scene_options.h"
#include "base/result.h"
#include "geo/body.h"
#include "objects/map_labels.h"
#include "objects/map_lines.h"

namespace terrella {

/// A map of a planet: its lines, and the names of its countries, seas and places.
struct MapData {
  std::vector<MapLine> lines;
  std::vector<MapName> names;
  std::vector<std::string> attributions;
  std::vector<std::byte> font;  ///< bytes of the font file of the names
};

/// True if there is a map of this body: of the Earth, or of any body with a file of places.
[[nodiscard]] bool has_map(const Body& body, const std::filesystem::path& places);

/// Throws a CLI::ValidationError that names the option, if --map asks for a map of a body that has none. thread: any
void check_map(const SceneOptions& options, const Body& body);

/// Reads the included map (data/vector/map.json), if the body is the Earth, and the names of places: those of a GeoJSON
/// file `places`, or the Earth's cities if the path is empty. The error names the file. thread: any
[[nodiscard]] Result<MapData> load_map(const Body& body, const std::filesystem::path& places);

/// The same text with letters of ASCII in place of letters with marks, "Sao Tome" for "São Tomé". Letters that have no
/// such form stay. thread: any
[[nodiscard]] std::string without_marks(std::string_view utf8);

}  // namespace terrella
