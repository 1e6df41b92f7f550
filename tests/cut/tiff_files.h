#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "codecs/image.h"

namespace terrella::test {

struct TiffKind {
  int bits = 8;
  int photometric = 2;  ///< PHOTOMETRIC_RGB
  int extra = -1;       ///< EXTRASAMPLE_…; -1: no extra sample
  int compression = 1;  ///< COMPRESSION_NONE
  int tile_px = 0;      ///< 0: strips
  int rows_per_strip = 7;
  bool big = false;  ///< BigTIFF
};

/// Writes the picture's channels as they are: 1, 3 or 4 of them by the kind, 16-bit samples as 257 times the 8-bit
/// ones. A palette picture has index i for red value i, and the palette (i, 255 - i, i / 2).
void write_tiff(const std::filesystem::path& path, const Image& image, const TiffKind& kind);

}  // namespace terrella::test
