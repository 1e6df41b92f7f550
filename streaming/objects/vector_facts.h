#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"

namespace terrella {

/// Facts of one layer of a vector file. Texts come from the file and may hold any character.
struct VectorLayerFacts {
  std::string name;
  std::string geometry;                         ///< OGR's name of the kind, such as "Polygon" or "3D Line String"
  std::int64_t features;                        ///< number of features, those without a place included
  std::string crs;                              ///< name of the coordinate system; empty if the layer names none
  std::string crs_code;                         ///< code, for example "EPSG:32632"; empty if unknown
  std::optional<std::array<double, 4>> bounds;  ///< west, south, east, north in units of the layer's system
  std::vector<std::pair<std::string, std::string>> fields;  ///< name and OGR's name of the type
};

/// Facts of a vector file.
struct VectorFacts {
  std::string format;  ///< GDAL's name of the format
  std::vector<VectorLayerFacts> layers;
  bool has_links = false;    ///< KML with links to features, or to a network, which are not followed
  std::size_t pictures = 0;  ///< ground overlays of KML, which are imagery
};

/// Most layers that describe_vector() describes.
inline constexpr int kMostVectorLayers = 1000;

/// Reads the layers of a vector file, but no objects. The error names the file. Blocks. thread: any
[[nodiscard]] Result<VectorFacts> describe_vector(const std::filesystem::path& path);

}  // namespace terrella
