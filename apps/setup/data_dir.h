#pragma once

#include <filesystem>
#include <stdexcept>
#include <string_view>

namespace terrella {

/// A file installed with the program is missing. No command can recover; main reports the error.
class BrokenInstallation : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Finds a file included with the program, for example "earth.gpkg". If the environment variable TERRELLA_DATA is set,
/// only that folder is searched. Otherwise data/ beside the program (a build) and ../share/terrella/ (an installation)
/// are searched. Throws BrokenInstallation, which names the places. thread: any
[[nodiscard]] std::filesystem::path data_file(std::string_view name);

}  // namespace terrella
