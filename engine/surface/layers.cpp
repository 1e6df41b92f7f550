#include "surface/layers.h"

#include "base/range_check.h"

namespace terrella {

Status check_look(const ImageLook& look) {
  return RangeCheck()
      .in("the opacity", look.opacity, 0.0, 1.0)
      .in("the layer's min_level", look.min_level, 0, kMaxTileLevel)
      .in("the layer's max_level", look.max_level, 0, kMaxTileLevel)
      .known("the daylight", look.daylight, Daylight::night)
      .known("the source of its alpha", look.alpha, AlphaFrom::brightness)
      .in("the height of the layer", look.height_m, 0.0, 1e6, " m")
      .part("the layer's numbers", look.numbers ? check_look(*look.numbers) : Status(Done{}))
      .result();
}

}  // namespace terrella
