#pragma once

#include <cstdint>
#include <optional>

#include "base/result.h"
#include "tiles/tile_grid.h"
#include "view/number_look.h"

namespace terrella {

/// Identifier of a layer, unique within its globe. `none` is no layer.
enum class LayerId : std::uint64_t { none = 0 };

/// Side of the terminator on which an image layer shows; the layer fades through civil twilight. A
/// globe that is unlit or has no time has no night: day layers then show everywhere, and night layers nowhere.
enum class Daylight {
  both,
  day,   ///< lit as any layer
  night  ///< shines by itself: the light of the Sun does not change its colours
};

/// Source of a layer's transparency.
enum class AlphaFrom {
  own,        ///< its tiles' alpha; without any they are opaque
  brightness  ///< the largest of red, green and blue counts too: black shows the layers below, as in cloud pictures
};

/// Appearance of an image layer; can change from frame to frame.
struct ImageLook {
  bool shown = true;
  double opacity = 1.0;  ///< [0, 1]; goes with the alpha of the layer's own tiles
  int min_level = 0;  ///< [0, kMaxTileLevel]; the layer is not drawn if the view asks for coarser tiles than this level
  int max_level =
      kMaxTileLevel;  ///< [0, kMaxTileLevel]; finer tiles are not requested: tiles of this level are magnified
  Daylight daylight = Daylight::both;
  AlphaFrom alpha = AlphaFrom::own;
  /// Height of an upper layer over the ellipsoid, metres, [0, 1e6], such as that of clouds. The layer moves against the
  /// ground and throws a shadow on it. An eye below this height sees the layer on the ground, and no shadow.
  double height_m = 0.0;
  /// Stretch and colour map: needed for a layer of numbers, empty for a layer of pictures.
  std::optional<NumberLook> numbers = {};
  bool operator==(const ImageLook&) const = default;
};

/// Fails if a value is out of its range, and names the value. thread: any
[[nodiscard]] Status check_look(const ImageLook& look);

}  // namespace terrella
