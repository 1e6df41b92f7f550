#pragma once

#include <optional>
#include <string>

#include "scene/render_modes.h"
#include "scene/utc_time.h"

namespace terrella {

/// What the panel shows and changes.
struct ViewSettings {
  SurfaceLook surface;
  StereoLook stereo;
  bool under_ground = false;  ///< changed: X is asked for
  bool has_sky = false;       ///< the globe can draw one
  bool sky = false;
  std::optional<UtcTime> time;  ///< none: light over the viewer's shoulder
  std::string time_text;        ///< as it is being written
  std::string time_problem;     ///< what is wrong with it; may be empty
  bool has_relief = false;
  double exaggeration = 1.0;
};

/// The panel, beside the left edge, with a word on each of its parts; between Ui::begin_frame() and Ui::end_frame().
/// `just_opened` gives it the keyboard. Changes `settings` as the person does. thread: main
void draw_view_settings(ViewSettings& settings, bool just_opened);

}  // namespace terrella
