#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "sky/cube_picture.h"
#include "sky/star_catalogue.h"

namespace terrella {

/// What the sky is drawn from. What could not be read is empty, and `problems` says why, naming the file: the sky is
/// then without it.
struct SkyData {
  std::vector<Star> stars;
  GreyPicture night_lights;
  std::vector<std::string> problems;
};

/// Reads the files that the program carries (apps/setup/data_dir.h). thread: any
[[nodiscard]] SkyData load_sky_data();

/// The errors name the file. thread: any
[[nodiscard]] Result<std::vector<Star>> load_stars(const std::filesystem::path& path);
/// A picture of the whole Earth; its red channel counts.
[[nodiscard]] Result<GreyPicture> load_night_lights(const std::filesystem::path& path);

}  // namespace terrella
