#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "codecs/image.h"
#include "streaming/cut/strip.h"

namespace terrella {

/// Encoding options of tiles.
struct TileCoding {
  ImageFormat format = ImageFormat::jpeg;
  int quality = 85;
  int finest = 0;                    ///< finest level; coarser JPEG tiles keep the colour of each pixel (4:4:4)
  bool heights = false;              ///< 16-bit gray PNG
  bool floats = false;               ///< TIFF of 32-bit floats, from PixelKind::number
  bool png_outline = false;          ///< a tile with transparent pixels becomes PNG instead of JPEG
  std::optional<float> nodata = {};  ///< with `floats`: written for NaN; none: NaN is written
};

/// Encodes tiles from strips and reuses its codec. JPEG: 4:2:0 on the finest level, accurate DCT, default Huffman
/// tables. PNG and WebP: like encode_png() and encode_webp(). thread: one at a time
class TileEncoder {
 public:
  explicit TileEncoder(const TileCoding& coding);
  [[nodiscard]] Result<std::vector<std::byte>> encode(const Strip& strip, std::int64_t index);

 private:
  struct DestroyHandle {
    void operator()(void* handle) const;
  };
  [[nodiscard]] Result<std::vector<std::byte>> encode_jpeg_tile(const Strip& strip, std::int64_t index);

  TileCoding coding_;
  std::unique_ptr<void, DestroyHandle> jpeg_;
  std::vector<unsigned char> buffer_;
};

}  // namespace terrella
