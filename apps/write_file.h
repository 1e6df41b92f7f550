#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "geo/result.h"

namespace terrella {

/// Writes a file so that it appears under its name, and replaces what had that name, only when it is whole. Devices and
/// pipes are written to as they are. The error names the path. thread: any
[[nodiscard]] Status write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace terrella
