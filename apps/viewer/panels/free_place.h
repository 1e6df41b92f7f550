#pragma once

#include <span>

#include "apps/viewer/panels/ui.h"

namespace terrella {

/// A stretch of the window, in its units.
struct UiSpan {
  double from = 0.0, to = 0.0;
  [[nodiscard]] double length() const { return to - from; }
};

/// The longest vertical stretch of `limits` between two x positions that no box touches; empty if there is none. On a
/// tie, the lowest on the screen. thread: any
[[nodiscard]] UiSpan free_height(UiSpan across, UiSpan limits, std::span<const UiBox> taken);

/// The first candidate that lies in the window and touches no box; null if there is none. thread: any
[[nodiscard]] const UiBox* first_free(std::span<const UiBox> candidates, UiBox window, std::span<const UiBox> taken);

}  // namespace terrella
