#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/georeference.h"
#include "streaming/raster/byte_file.h"

namespace terrella {

/// Sample type of a TIFF, as far as resampling needs it.
enum class SampleKind { colours, uint16, int16, floats };

/// Tags of a TIFF that give its place (OGC 19-008r4, section 7), with their types checked.
struct GeoTags {
  std::vector<std::uint16_t> key_directory;
  std::vector<double> key_numbers;
  std::string key_text;
  std::vector<double> pixel_scale;  ///< x, y, z
  std::vector<double> tie_points;   ///< i, j, k, x, y, z of each point
  std::vector<double> matrix;       ///< 4×4, by rows
  bool has_rpc = false;             ///< coefficients of a camera model (tag 50844)
  bool has_palette = false;
  SampleKind samples = SampleKind::colours;  ///< kinds other than colours have one sample per pixel
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;

  [[nodiscard]] bool has_place() const {
    return !pixel_scale.empty() || !tie_points.empty() || !matrix.empty() || has_rpc;
  }
};

/// Reads the tags of the first picture in the file; none if the file is no TIFF. The error names a tag of a wrong type,
/// but not the file. thread: any
[[nodiscard]] Result<std::optional<GeoTags>> read_geo_tags(const std::filesystem::path& picture);
/// The same from the bytes of a TIFF.
[[nodiscard]] Result<GeoTags> read_geo_tags(const std::shared_ptr<const ByteFile>& bytes);
/// Reads the tags of a picture from its file or its bytes.
[[nodiscard]] Result<std::optional<GeoTags>> read_geo_tags(const PictureFile& picture);

}  // namespace terrella
