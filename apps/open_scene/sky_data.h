#pragma once

#include <string>
#include <vector>

#include "sky/cube_picture.h"
#include "sky/star_catalogue.h"

namespace terrella {

/// Data for drawing the sky. Unreadable parts are empty and not drawn; `problems` names their files and the reasons.
struct SkyData {
  std::vector<Star> stars;
  GreyPicture night_lights;
  std::vector<std::string> problems;
};

/// Reads the included files (apps/process/data_dir.h); the city lights only if a night may be drawn. thread: any
[[nodiscard]] SkyData load_sky_data(bool night_lights = true);

}  // namespace terrella
