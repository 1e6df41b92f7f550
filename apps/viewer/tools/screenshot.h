#pragma once

#include <chrono>
#include <filesystem>

#include "base/result.h"
#include "geo/camera.h"

namespace terrella {

/// Returns "terrella-YYYYmmdd-HHMMSS.png" in local time. A number is added if the folder already has a file of that
/// second.
[[nodiscard]] std::filesystem::path screenshot_name(const std::filesystem::path& folder,
                                                    std::chrono::system_clock::time_point when);

/// Writes the window's back buffer to a PNG file. The error names the file. thread: main, with the context current
[[nodiscard]] Status save_back_buffer(const std::filesystem::path& file, Viewport framebuffer);

}  // namespace terrella
