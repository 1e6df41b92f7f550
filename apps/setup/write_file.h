#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// Writes a file so that it appears under its name, and replaces what had that name, only when it is whole. Devices and
/// pipes are written to as they are. The error names the path. thread: any
[[nodiscard]] Status write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Refuses to replace what is no picture, and what lies in one of the inputs (files, folders; addresses count for
/// nothing) or is one by any name. The error says what stands there. thread: any
[[nodiscard]] Status may_write_picture(const std::filesystem::path& path, const std::vector<std::string>& inputs);

}  // namespace terrella
