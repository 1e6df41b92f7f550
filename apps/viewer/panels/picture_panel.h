#pragma once

#include "geo/camera.h"

namespace terrella {

inline constexpr const char* kPictureTitle = "Save a picture";

/// What the panel of pictures holds between frames.
struct PicturePanel {
  int width_px = 0, height_px = 0;  ///< 0: twice the window's, from the next frame on
  bool just_opened = false;
};

enum class PictureAsk { none, save, close };

/// Asks how large a picture shall be, in the middle of the window; between Ui::begin_frame() and Ui::end_frame().
/// `most_px`: largest side. thread: main
[[nodiscard]] PictureAsk draw_picture_panel(PicturePanel& panel, Viewport window, int most_px);

}  // namespace terrella
