#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/panels/legend.h"
#include "apps/viewer/panels/readout.h"
#include "apps/viewer/tools/map_painter.h"
#include "base/result.h"
#include "globe/globe.h"

namespace terrella {

/// The parts of the window that a picture shows over the globe.
struct PictureOverlay {
  bool graticule = false;
  MapPainter* map = nullptr;                    ///< null: no map
  std::vector<LegendItem> legend = {};          ///< at the lower left corner
  std::vector<std::string> credits = {};        ///< sources, at the upper right corner
  std::optional<LengthUnits> scale_units = {};  ///< units of the scale bar at the lower right corner; none: no bar

  [[nodiscard]] bool empty() const {
    return !graticule && map == nullptr && legend.empty() && credits.empty() && !scale_units;
  }
};

/// Draws over the globe's picture in a framebuffer, as the window does. Texts are larger in higher pictures. The
/// framebuffer is `unit_px` times as wide and high as `size`, and so are texts and lines in it. Fails if
/// Dear ImGui finds no OpenGL, or if the picture has no room for the credits. Not within a frame of a window; at most
/// one call at a time. thread: that of the OpenGL context
[[nodiscard]] Status draw_over_picture(const Globe& globe, unsigned framebuffer, Viewport size,
                                       const PictureOverlay& overlay, int unit_px = 1);

}  // namespace terrella
