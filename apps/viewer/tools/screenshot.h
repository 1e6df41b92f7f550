#pragma once

#include <chrono>
#include <filesystem>

#include "base/result.h"
#include "geo/camera.h"

namespace terrella {

/// "terrella-YYYYmmdd-HHMMSS.png" by local time; a number is added if the folder has one of that second already.
[[nodiscard]] std::filesystem::path screenshot_name(const std::filesystem::path& folder,
                                                    std::chrono::system_clock::time_point when);

/// Writes the window's back buffer to a PNG file. The error names the file. thread: main, with the context current
[[nodiscard]] Status save_back_buffer(const std::filesystem::path& file, Viewport framebuffer);

}  // namespace terrella
