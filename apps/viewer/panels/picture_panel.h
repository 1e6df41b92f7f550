#pragma once

#include "geo/camera.h"

namespace terrella {

inline constexpr const char* kPictureTitle = "Save picture";

/// State of the picture panel between frames.
struct PicturePanel {
  int width_px = 0, height_px = 0;  ///< 0: twice the window's size, set in the next frame
  bool just_opened = false;
};

enum class PictureAsk { none, save, close };

/// Draws a panel for the size of a saved picture, in the middle of the window, between Ui::begin_frame() and
/// Ui::end_frame(). `most_px` is the largest side. thread: main
[[nodiscard]] PictureAsk draw_picture_panel(PicturePanel& panel, Viewport window, int most_px);

}  // namespace terrella
