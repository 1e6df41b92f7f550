#pragma once

#include <optional>
#include <string>

#include "sky/utc_time.h"
#include "view/render_modes.h"

namespace terrella {

inline constexpr const char* kViewTitle = "View";

/// What the panel shows and changes.
struct ViewSettings {
  SurfaceLook surface;
  StereoLook stereo;
  bool under_ground = false;  ///< changed: X is asked for
  bool has_sky = false;       ///< the globe can draw one
  bool sky = false;
  std::optional<UtcTime> time;     ///< none: light over the viewer's shoulder
  std::string time_text;           ///< as it is being written
  std::string time_problem;        ///< what is wrong with it; may be empty
  std::optional<UtcTime> written;  ///< what `time_text` was last made of
  bool has_relief = false;
  double exaggeration = 1.0;
};

/// The time as its field has it; empty without one. thread: any
[[nodiscard]] std::string time_field(std::optional<UtcTime> time);

/// Another panel that is asked for.
enum class ViewAsk { none, layers, picture, help };

/// The panel, beside the left edge, with a word on each of its parts; between Ui::begin_frame() and Ui::end_frame().
/// `just_opened` gives it the keyboard. Changes `settings` as the person does. thread: main
ViewAsk draw_view_settings(ViewSettings& settings, bool just_opened);

}  // namespace terrella
