#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "streaming/raster/byte_file.h"
#include "streaming/raster/tiff_metadata.h"
#include "streaming/raster/tiff_picture.h"

namespace terrella {

/// A directory and the file that contains it.
struct TiffPart {
  std::shared_ptr<const ByteFile> file;
  TiffPicture picture;
};

struct TiffLevel {
  TiffPart part;
  std::optional<TiffPart> mask;  ///< mask of the same size

  /// True if parts of the level, and of its mask, can be read by themselves.
  [[nodiscard]] bool has_blocks() const { return part.picture.has_blocks() && (!mask || mask->picture.has_blocks()); }
};

/// The first picture of a TIFF with its overviews and masks, in the file and in FILE.ovr and FILE.msk beside it.
struct TiffPyramid {
  std::vector<TiffLevel> levels;  ///< the coarsest first; the last is the picture itself
  TiffMetadata metadata;
  [[nodiscard]] const TiffLevel& whole() const { return levels.back(); }
};

/// Reads all directories. Overviews that do not fit the picture (another kind of sample, another shape, without the
/// picture's mask) are left out. The error names the file, the damage and a cure. Blocks. thread: any
[[nodiscard]] Result<TiffPyramid> read_pyramid(const std::filesystem::path& path);
/// The same for a file without files beside it.
[[nodiscard]] Result<TiffPyramid> read_pyramid(const std::shared_ptr<const ByteFile>& file);

}  // namespace terrella
