#pragma once

#include <filesystem>
#include <stdexcept>
#include <string_view>

namespace terrella {

/// Something that is installed with the program is not there. Nothing that a command could do instead: it ends in main.
class BrokenInstallation : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that the program carries, for example "earth.gpkg". It is looked for in the folder that the environment
/// variable TERRELLA_DATA names, if it is set, and nowhere else then; otherwise in data/ beside the program (a build)
/// and in
/// ../share/terrella/ (an installation). Throws BrokenInstallation, which names the places.
/// thread: any
[[nodiscard]] std::filesystem::path data_file(std::string_view name);

}  // namespace terrella
