#include "surface/layers.h"

#include <cmath>

#include "base/range_check.h"

namespace terrella {

namespace {

Status check_tone(const ImageLook& look) {
  if (!look.numbers || look.tone == ImageTone{}) return Done{};
  return Error{"numbers have the colours of their map; change its stretch or its colours"};
}

Status check_blend(const ImageLook& look) {
  if (look.blend == LayerBlend::normal || !(look.height_m > 0.0)) return Done{};
  return Error{"a layer with a height is drawn normally; set its height to 0, or its blend to normal"};
}

}  // namespace

double swipe_px(double line, int width_px) { return std::round(line * width_px); }

bool shows_at(SwipeSide side, const std::optional<double>& line, double x_px, int width_px) {
  if (!line || side == SwipeSide::both) return true;
  return (x_px < swipe_px(*line, width_px)) == (side == SwipeSide::before);
}

Status check_look(const ImageLook& look) {
  return RangeCheck()
      .in("the opacity", look.opacity, 0.0, 1.0)
      .in("the layer's min_level", look.min_level, 0, kMaxTileLevel)
      .in("the layer's max_level", look.max_level, 0, kMaxTileLevel)
      .known("the daylight", look.daylight, Daylight::night)
      .known("the source of its alpha", look.alpha, AlphaFrom::brightness)
      .known("the side of the swipe", look.swipe, SwipeSide::behind)
      .known("the clock of the layer", look.clock, LayerClock::globe_fades)
      .known("the blend", look.blend, LayerBlend::difference)
      .part("the layer's blend", check_blend(look))
      .in("the height of the layer", look.height_m, 0.0, 1e6, " m")
      .in("the brightness", look.tone.brightness, -1.0, 1.0)
      .in("the contrast", look.tone.contrast, 0.0, 4.0)
      .in("the gamma", look.tone.gamma, 0.1, 10.0)
      .part("the layer's tone", check_tone(look))
      .part("the layer's numbers", look.numbers ? check_look(*look.numbers) : Status(Done{}))
      .result();
}

}  // namespace terrella
