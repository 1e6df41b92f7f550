#pragma once

#include <optional>
#include <span>
#include <string>

#include "apps/viewer/action.h"
#include "apps/viewer/panels/readout.h"
#include "base/utc_time.h"
#include "view/render_modes.h"

namespace terrella {

/// Values that the panel shows and changes.
struct ViewSettings {
  SurfaceLook surface;
  StereoLook stereo;
  bool under_ground = false;  ///< a change has the effect of key X
  bool has_sky = false;       ///< true if the globe can draw a sky
  bool sky = false;
  std::optional<UtcTime> time;     ///< none: light over the viewer's shoulder
  std::string time_text;           ///< text as typed so far
  std::string time_problem;        ///< fault in the text; may be empty
  std::optional<UtcTime> written;  ///< time last written to `time_text`
  bool has_lights = false;         ///< true if the globe can draw city lights
  bool night_lights = false;
  bool playing = false;  ///< the time runs
  double speed = 1.0;    ///< seconds of the sky per second
  bool has_relief = false;
  double exaggeration = 1.0;
  LengthUnits units = LengthUnits::metric;
};

/// Text of a time for its field; empty without a time. thread: any
[[nodiscard]] std::string time_field(std::optional<UtcTime> time);

/// Draws the panel with its tips at the left edge, between Ui::begin_frame() and Ui::end_frame(). `foot` units at
/// the lower edge stay free. `just_opened` gives the panel the keyboard. Stores the user's changes in `settings`.
/// Returns the action whose button was clicked; null if none was. thread: main
[[nodiscard]] const Action* draw_view_settings(const char* title, ViewSettings& settings,
                                               std::span<const Action> actions, float foot, bool just_opened);

}  // namespace terrella
