#pragma once

#include <chrono>
#include <filesystem>
#include <string_view>

#include "base/result.h"
#include "geo/camera.h"

namespace terrella {

/// Returns "terrella-YYYYmmdd-HHMMSS" with an ending such as ".png", in local time. A number is added if the folder
/// already has a file of that second.
[[nodiscard]] std::filesystem::path new_file_name(const std::filesystem::path& folder,
                                                  std::chrono::system_clock::time_point when,
                                                  std::string_view ending = ".png");

/// Writes the window's back buffer to a PNG file. The error names the file. thread: main, with the context current
[[nodiscard]] Status save_back_buffer(const std::filesystem::path& file, Viewport framebuffer);

}  // namespace terrella
