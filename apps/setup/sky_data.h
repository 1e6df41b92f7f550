#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "sky/cube_picture.h"
#include "sky/star_catalogue.h"

namespace terrella {

/// Data for drawing the sky. Unreadable parts are empty and not drawn; `problems` names their files and the reasons.
struct SkyData {
  std::vector<Star> stars;
  GreyPicture night_lights;
  std::vector<std::string> problems;
};

/// Reads the included files (apps/setup/data_dir.h); the city lights only if a night may be drawn. thread: any
[[nodiscard]] SkyData load_sky_data(bool night_lights = true);

/// Reads a star catalogue. The error names the file. thread: any
[[nodiscard]] Result<std::vector<Star>> load_stars(const std::filesystem::path& path);
/// Reads a picture of the whole Earth; only the red channel is used.
[[nodiscard]] Result<GreyPicture> load_night_lights(const std::filesystem::path& path);

}  // namespace terrella
