#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "surface/layers.h"

namespace terrella {

/// Gives the topmost shown image layer the side before the swipe's line, and the next one the side behind it, unless a
/// layer has a side already. The lowest layer keeps both sides: it shows through the others. `looks`: of all image
/// layers, lowest first. Returns false if fewer than two are shown. thread: any
[[nodiscard]] inline bool choose_swipe_sides(std::span<ImageLook> looks) {
  const auto has_side = [](const ImageLook& look) { return look.shown && look.swipe != SwipeSide::both; };
  if (std::ranges::any_of(looks, has_side)) return true;
  std::vector<ImageLook*> shown;
  for (ImageLook& look : looks) {
    if (look.shown) shown.insert(shown.begin(), &look);
  }
  if (shown.size() < 2) return false;
  shown[0]->swipe = SwipeSide::before;
  if (shown.size() > 2) shown[1]->swipe = SwipeSide::behind;
  return true;
}

}  // namespace terrella
