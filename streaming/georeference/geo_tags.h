#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// What a TIFF's samples are, as far as it matters for resampling them.
enum class SampleKind { colours, uint16, int16, floats };

/// The tags of a TIFF that say where it lies (OGC 19-008r4, section 7), with their types checked.
struct GeoTags {
  std::vector<std::uint16_t> key_directory;
  std::vector<double> key_numbers;
  std::string key_text;
  std::vector<double> pixel_scale;  ///< x, y, z
  std::vector<double> tie_points;   ///< i, j, k, x, y, z of each
  std::vector<double> matrix;       ///< 4×4, by rows
  bool has_rpc = false;             ///< coefficients of a camera model (tag 50844)
  bool has_palette = false;
  SampleKind samples = SampleKind::colours;  ///< all but colours: one sample a pixel
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;

  [[nodiscard]] bool has_place() const {
    return !pixel_scale.empty() || !tie_points.empty() || !matrix.empty() || has_rpc;
  }
};

/// Reads the tags of the file's first picture; none if it is no TIFF. The error, which has no file's name,
/// names a tag of a wrong type.
/// thread: any
[[nodiscard]] Result<std::optional<GeoTags>> read_geo_tags(const std::filesystem::path& picture);

}  // namespace terrella
