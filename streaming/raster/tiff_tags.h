#pragma once

#include <string_view>

#include "streaming/raster/byte_file.h"

namespace terrella {

/// Tags in the first directory of a TIFF that GDAL does not pass on.
struct TiffTags {
  bool other = false;          ///< a colour space besides gray, a palette, RGB, CMYK and YCbCr
  bool rgb = false;            ///< the first three samples of a pixel are red, green and blue
  bool has_alpha = false;      ///< the sample after the colours is their opacity
  bool premultiplied = false;  ///< the colours are multiplied by it
  bool in_strips = false;      ///< the picture has no tiles
  bool has_place = false;      ///< there are tags of a place: a scale, tie points or a matrix
  int orientation = 1;         ///< the Orientation tag: another value turns the stored rows
  bool has_system = false;     ///< there are keys of a coordinate system
};

/// Reads the tags of a TIFF; the defaults if it cannot be read. Blocks. thread: any
[[nodiscard]] TiffTags read_tiff_tags(const ByteFile& file);

/// True for the first bytes of a TIFF or BigTIFF in either byte order. thread: any
[[nodiscard]] bool begins_as_tiff(std::string_view head);

}  // namespace terrella
