#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "apps/viewer/panels/readout.h"
#include "objects/graticule.h"

namespace terrella {

/// Contents of the status line.
struct PanelStatus {
  std::string cursor;       ///< latitude and longitude under the cursor; empty beside the globe
  std::string eye;          ///< height of the eye
  std::string tiles;        ///< empty when no tile is loading
  std::string frame;        ///< frame time
  std::string message;      ///< message of the last action, shown for some seconds; may be empty
  std::string job;          ///< running job and its progress; may be empty
  std::string measure;      ///< current measurement; may be empty
  std::string attribution;  ///< attribution of the visible layers; may be empty
  std::optional<ScaleBar> scale;
};

// Call these functions between Ui::begin_frame() and Ui::end_frame(). `unit_px`: framebuffer pixels per unit of the
// window. thread: main

/// Draws the status line, the scale bar and the attribution.
void draw_status(const PanelStatus& status, double unit_px);
/// Draws the list of shortcuts in the middle.
void draw_help();
/// Part of the picture for one graticule, framebuffer pixels; lines and labels are clipped to this part.
struct GraticulePart {
  int left_px = 0;
  Viewport size;
  glm::vec3 tint{1.0F};  ///< colour of lines and labels
};
/// Draws lines and labels below the panels.
void draw_graticule(const Graticule& graticule, const GraticulePart& part, double unit_px);

}  // namespace terrella
