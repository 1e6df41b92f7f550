#pragma once

#include <string>

namespace terrella {

/// The user's request by the buttons of the row.
enum class MeasureAsk { none, undo, copy, save, keep, profile, end };

/// Draws a measurement and its buttons where no panel of this frame is: at the top, or else over the status line, which
/// uses `foot` units at the lower edge. A small window shows no buttons, or nothing. Call this after the frame's
/// panels, between Ui::begin_frame() and Ui::end_frame(). thread: main
[[nodiscard]] MeasureAsk draw_measure_row(const std::string& text, float foot);

}  // namespace terrella
