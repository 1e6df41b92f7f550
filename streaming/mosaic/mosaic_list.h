#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/georeference.h"

namespace terrella {

/// A file of a mosaic, with the values that the description states for it.
struct MosaicEntry {
  std::filesystem::path path;
  PlaceWords words{};  ///< replaces the place that the file states
  /// Longitude and latitude, degrees, of its lower left, lower right, upper right and upper left corner; replaces both
  /// the file's place and `words`.
  std::optional<std::array<CrsPoint, 4>> corners = {};
  std::optional<double> nodata = {};  ///< replaces the file's own
  std::optional<double> scale = {};   ///< the same; value = stored number · scale + offset
  std::optional<double> offset = {};
  double order = 0.0;  ///< a higher one lies on top, whatever the resolution
};

/// The files of a mosaic in the order given: a later file lies over an earlier one of the same resolution.
struct MosaicList {
  std::string name;
  std::string attribution;
  std::vector<MosaicEntry> entries;
  std::vector<std::string> remarks = {};  ///< statements of the description that the mosaic does not show
};

/// True for a folder with rasters that is no tile set, for a list of files (*.txt, *.lst), for a KML or KMZ file by its
/// name, and for a JSON file with the field "mosaic". Reads no raster. thread: any
[[nodiscard]] bool is_mosaic(const std::filesystem::path& path);

/// Reads the names (streaming/mosaic/README.md). Folders are searched with all folders inside them; their files are in
/// the order of their names. Paths are relative to the list. The pictures of a KMZ file are unpacked into the folder
/// `unpacked`. The error names the list. Blocks. thread: any
[[nodiscard]] Result<MosaicList> read_mosaic_list(const std::filesystem::path& path,
                                                  const std::filesystem::path& unpacked = {});

}  // namespace terrella
