#pragma once

#include <optional>
#include <string>

#include "apps/viewer/panels/readout.h"
#include "apps/viewer/panels/ui.h"

namespace terrella {

/// Contents of the status line.
struct PanelStatus {
  std::string cursor;       ///< latitude and longitude under the cursor; empty beside the globe
  std::string eye;          ///< height of the eye
  std::string tiles;        ///< empty when no tile is loading
  std::string time;         ///< time of the sky; empty without one
  std::string message;      ///< message of the last action, shown for some seconds; may be empty
  std::string job;          ///< running job and its progress; may be empty
  std::string measure;      ///< current measurement; may be empty
  std::string attribution;  ///< attribution of the visible layers; may be empty
  std::optional<ScaleBar> scale;
};

/// Draws the status line, the scale bar, the attribution and the measurement, between Ui::begin_frame() and
/// Ui::end_frame(). A narrow window shows the scale bar above the status line, and leaves out the last fields. The
/// attribution is wrapped, never cut. `unit_px`: framebuffer pixels per unit of the window. Returns the height that the
/// panels at the lower edge use, in units. thread: main
float draw_status(const PanelStatus& status, double unit_px);

/// Draws the job and the message over the globe, beside or above the panels that are drawn by now, and above the `foot`
/// units at the lower edge. Returns their rectangle; nullopt without text. thread: main
std::optional<UiBox> draw_message(const PanelStatus& status, float foot);

}  // namespace terrella
