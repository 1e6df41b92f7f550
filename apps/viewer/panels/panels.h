#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "apps/viewer/panels/readout.h"
#include "objects/graticule.h"

namespace terrella {

/// What the status line says.
struct PanelStatus {
  std::string cursor;       ///< latitude and longitude under the cursor; empty beside the globe
  std::string eye;          ///< height of the eye
  std::string tiles;        ///< empty when none is loading
  std::string frame;        ///< frame time
  std::string message;      ///< of the last action, for some seconds; may be empty
  std::string job;          ///< what is being done and how far it is; may be empty
  std::string measure;      ///< what is being measured; may be empty
  std::string attribution;  ///< of what is on screen; may be empty
  std::optional<ScaleBar> scale;
};

// Each is called between Ui::begin_frame() and Ui::end_frame(). `unit_px`: framebuffer pixels per unit of the window.
// thread: main

/// The line along the bottom, the scale bar and the attribution.
void draw_status(const PanelStatus& status, double unit_px);
/// The list of keys, in the middle.
void draw_help();
/// Where a graticule is drawn, framebuffer pixels; nothing of it reaches out of its part of the picture.
struct GraticulePart {
  int left_px = 0;
  Viewport size;
  glm::vec3 tint{1.0F};  ///< of lines and labels
};
/// Lines and labels, under the panels.
void draw_graticule(const Graticule& graticule, const GraticulePart& part, double unit_px);

}  // namespace terrella
