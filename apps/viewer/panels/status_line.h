#pragma once

#include <optional>
#include <string>

#include "apps/viewer/panels/readout.h"

namespace terrella {

/// Contents of the status line.
struct PanelStatus {
  std::string cursor;       ///< latitude and longitude under the cursor; empty beside the globe
  std::string eye;          ///< height of the eye
  std::string tiles;        ///< empty when no tile is loading
  std::string time;         ///< time of the sky; empty without one
  std::string message;      ///< message of the last action; may be empty
  bool is_fault = false;    ///< the message begins with a fault, which stays until Esc closes it
  std::string job;          ///< running job and its progress; may be empty
  std::string attribution;  ///< attribution of the visible layers; may be empty
  /// The attribution that was last shown, or will be: while an opaque layer hides it, its room stays free, so that no
  /// panel jumps under the pointer when it comes.
  std::string last_attribution = {};
  std::optional<ScaleBar> scale;
};

// The following functions draw between Ui::begin_frame() and Ui::end_frame(), in this order. thread: main

/// Draws the status line and the scale bar. A narrow window shows the scale bar above the status line, and leaves out
/// the last fields; a low one has no scale bar. `unit_px`: framebuffer pixels per unit of the window. Returns the
/// height that they use at the lower edge, in units.
float draw_status(const PanelStatus& status, double unit_px);

/// Draws a scale bar alone in the lower right corner of a picture, whose pixels are the units.
void draw_scale(const ScaleBar& bar);

/// Draws the job and the message above the `foot` units at the lower edge, beside the panels of the last frame if there
/// is room.
void draw_message(const PanelStatus& status, float foot);

/// Name of the panel that draw_head() draws.
inline constexpr const char* kAttributionBox = "##attribution";

/// Draws the attribution at the upper edge, wrapped, unless a tiny window has no room beside the message.
void draw_head(const PanelStatus& status);

}  // namespace terrella
