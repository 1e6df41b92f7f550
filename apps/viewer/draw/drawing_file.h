#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/viewer/draw/drawing.h"
#include "base/result.h"

namespace terrella {

/// A drawing as GeoJSON (RFC 7946) with the properties of simplestyle 1.1.0. Shapes: geojson_shape.h. thread: any
[[nodiscard]] std::string drawing_geojson(const Drawing& drawing);

/// A drawing as KML 2.2. Marks lie on the ground. Longitudes are in [-180, 180]; an edge is the shorter way between its
/// ends. thread: any
[[nodiscard]] std::string drawing_kml(const Drawing& drawing);

/// Writes a drawing as KML to a file that ends in .kml, or as GeoJSON to one that ends in .geojson or .json. The whole
/// file appears at once. The error names the file. thread: any
[[nodiscard]] Status save_drawing(const std::filesystem::path& file, const Drawing& drawing);

/// A drawing from a file, and what it does not have of the file.
struct OpenedDrawing {
  Drawing drawing;
  std::size_t left_out = 0;             ///< objects that no mark can be
  std::vector<std::string> complaints;  ///< faulty parts of the file
};

/// Reads the marks of GeoJSON, KML or another vector file. The error names the file. Blocks. thread: any
[[nodiscard]] Result<OpenedDrawing> open_drawing(const std::filesystem::path& file);
/// The same for the text of a GeoJSON file. The error begins with `where`.
[[nodiscard]] Result<OpenedDrawing> parse_drawing(const std::string& geojson, const std::string& where);

}  // namespace terrella
