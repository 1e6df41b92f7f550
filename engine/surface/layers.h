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

/// Change of a layer's colours, before light and air. A value c of a channel becomes
/// ((c - 0.5) · contrast + 0.5 + brightness)^(1/gamma), within [0, 1].
struct ImageTone {
  double brightness = 0.0;  ///< [-1, 1]
  double contrast = 1.0;    ///< [0, 4]
  double gamma = 1.0;       ///< [0.1, 10]; more is brighter
  bool operator==(const ImageTone&) const = default;
};

/// Side of the swipe's line (SurfaceLook::swipe) on which an image layer shows. Without a line it shows everywhere.
enum class SwipeSide {
  both,
  before,  ///< to the left of the line
  behind   ///< to the right of the line
};

/// Choice of the instant that an image layer shows, if its source has instants (TileSetInfo::steps).
enum class LayerClock {
  own,  ///< Globe::set_layer_time() chooses
  /// The last one at or before the globe's time; if that is missing, one of the three before it. Without such an
  /// instant the layer does not show.
  globe,
  /// As globe, and the next instant fades in over the shown one in proportion to the time. An instant whose tiles have
  /// not come, or none of which can be had, does not fade in: it appears at its time, or is missing. A layer with
  /// another blend than normal does not fade. Where two tiles with transparent parts are both opaque, up to a quarter
  /// of what lies under them shows while they fade.
  globe_fades
};

/// Combination of an image layer's colour c with the colour b of the layers below it, channel by channel. Values are
/// stored ones (sRGB) in [0, 1], before light and air, as editors of pictures and maps blend. Alpha and opacity then
/// mix the result with b, as they do with `normal`.
enum class LayerBlend {
  normal,     ///< c
  multiply,   ///< b · c
  screen,     ///< b + c - b · c
  difference  ///< |b - c|
};

/// Abscissa of the line of SurfaceLook::swipe in a picture, a whole number: it lies between two columns of pixels.
/// thread: any
[[nodiscard]] double swipe_px(double line, int width_px);
/// True if a layer of that side shows at an abscissa of a picture that is `width_px` wide. thread: any
[[nodiscard]] bool shows_at(SwipeSide side, const std::optional<double>& line, double x_px, int width_px);

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
  SwipeSide swipe = SwipeSide::both;
  LayerClock clock = LayerClock::own;  ///< without a time of the globe, or without instants, as own
  /// Plain colour that shows below through holes of the lowest layer counts as a layer's colour, too.
  /// The lowest layer that is drawn is always `normal`, and a layer with a height must be. Unlit numbers, and a layer
  /// directly over them, blend with the colours in the picture instead, and are not lit.
  LayerBlend blend = LayerBlend::normal;
  /// Tone of a layer of pictures. The sea in a lowest layer with one does not mirror the Sun.
  ImageTone tone{};
  /// Stretch and colour map: needed for a layer of numbers, empty for a layer of pictures.
  std::optional<NumberLook> numbers = {};
  bool operator==(const ImageLook&) const = default;
};

/// Fails if a value is out of its range, and names the value. thread: any
[[nodiscard]] Status check_look(const ImageLook& look);

}  // namespace terrella
