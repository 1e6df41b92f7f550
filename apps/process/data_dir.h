#pragma once

#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace terrella {

/// A file installed with the program is missing. No command can recover; main reports the error.
class BrokenInstallation : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Sets the folders that data_file() searches instead of those of the program. Call it before the first search. thread:
/// main
void set_data_folders(std::vector<std::filesystem::path> folders);

/// Finds a file included with the program, for example "earth.gpkg". If the environment variable TERRELLA_DATA is set,
/// only that folder is searched. Otherwise the folders of set_data_folders() are searched, or data/ beside the program
/// (a build) and ../share/terrella/ (an installation). Throws BrokenInstallation, which names the places. thread: any
[[nodiscard]] std::filesystem::path data_file(std::string_view name);

}  // namespace terrella
