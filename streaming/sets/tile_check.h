#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "base/result.h"

namespace terrella {

/// Text of an exception that a server of the OGC's services sends as XML where a picture was wanted, on one line, at
/// most 300 bytes, addresses redacted. Empty for other texts. thread: any
[[nodiscard]] std::string server_exception(std::string_view text);

/// Sides that a tile may have, pixels. Both are the set's, except where a stored raster ends.
struct TileSides {
  int least_width_px = 0, least_height_px = 0;
  int most_px = 0;
  bool floats = false;  ///< the tile is a TIFF of heights; only its first bytes are checked
};

/// Quick check of a tile's bytes from a server: begins as a JPEG, PNG or WebP, has `tile_px` pixels a side in its
/// header, and ends properly. Decodes no pixel (2 µs rather than 1 ms); `terrella info --verify` decodes. The error
/// says what came instead. thread: any
[[nodiscard]] Status check_tile(std::span<const std::byte> bytes, int tile_px);
[[nodiscard]] Status check_tile(std::span<const std::byte> bytes, const TileSides& sides);

}  // namespace terrella
