#pragma once

#include <span>

#include "apps/viewer/action.h"
#include "geo/angle.h"

namespace terrella {

/// Actions of the control column in a frame.
struct ControlColumn {
  const Action* clicked = nullptr;
  bool held = false;  ///< true while a button is held: it repeats, so frames are needed
};

/// Draws a column of buttons for the actions with an icon: compass, zoom, tilt, home, back, forward. It stands at the
/// right edge, or further left, where no panel of this frame is. Buttons without room are left out; the menu hides
/// the column. Call this after all
/// panels, between Ui::begin_frame() and Ui::end_frame(). `heading`: of the view, for the compass. thread: main
[[nodiscard]] ControlColumn draw_control_column(std::span<const Action> actions, Angle heading);

}  // namespace terrella
