#pragma once

#include <filesystem>
#include <vector>

#include "base/result.h"
#include "globe/globe_options.h"
#include "sky/cube_picture.h"
#include "sky/star_catalogue.h"

namespace terrella {

/// Fills stars, city lights and the font of labels, if they are empty, from the files of a data folder:
/// Terrella_DATA_DIR of the package, or a folder with the same files. Stars and lights are read only for a sky. The
/// first file that cannot be read is the error, with its name, and the options are as before. thread: any
Status add_data(GlobeOptions& options, const std::filesystem::path& folder);

/// Reads a star catalogue. The error names the file. thread: any
[[nodiscard]] Result<std::vector<Star>> load_stars(const std::filesystem::path& path);
/// Reads a picture of the whole Earth; only the red channel is used. The error names the file. thread: any
[[nodiscard]] Result<GreyPicture> load_night_lights(const std::filesystem::path& path);

}  // namespace terrella
