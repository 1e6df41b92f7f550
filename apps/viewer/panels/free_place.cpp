#include "apps/viewer/panels/free_place.h"

#include <algorithm>
#include <vector>

namespace terrella {

UiSpan free_height(UiSpan across, UiSpan limits, std::span<const UiBox> taken) {
  std::vector<UiSpan> closed;
  for (const UiBox& box : taken) {
    if (box.left < across.to && across.from < box.right) closed.push_back({box.top, box.bottom});
  }
  std::ranges::sort(closed, {}, &UiSpan::from);
  closed.push_back({limits.to, limits.to});
  UiSpan longest{limits.to, limits.to};
  double free_from = limits.from;
  for (const UiSpan& next : closed) {
    const UiSpan free{free_from, std::min(next.from, limits.to)};
    if (free.length() > 0.0 && free.length() >= longest.length()) longest = free;
    free_from = std::max(free_from, next.to);
  }
  return longest;
}

const UiBox* first_free(std::span<const UiBox> candidates, UiBox window, std::span<const UiBox> taken) {
  const auto found = std::ranges::find_if(candidates, [&](const UiBox& box) {
    const bool inside =
        box.left >= window.left && box.top >= window.top && box.right <= window.right && box.bottom <= window.bottom;
    return inside && std::ranges::none_of(taken, [&box](const UiBox& other) { return other.overlaps(box); });
  });
  return found == candidates.end() ? nullptr : &*found;
}

}  // namespace terrella
