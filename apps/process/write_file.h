#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// Writes a file atomically: the complete file appears under its name and replaces an earlier file. Devices and pipes
/// are written directly. The error names the path. thread: any
[[nodiscard]] Status write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Refuses to replace a file that is no picture, an input under any name, or a file inside an input folder. Addresses
/// among the inputs are ignored. The error describes the existing file. thread: any
[[nodiscard]] Status may_write_picture(const std::filesystem::path& path, const std::vector<std::string>& inputs);

}  // namespace terrella
