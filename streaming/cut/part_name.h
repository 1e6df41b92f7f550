#pragma once

#include <filesystem>

#include "geo/result.h"

namespace terrella {

/// A name beside `output` for what is not whole yet: hidden, and no other process or call uses it. thread: any
[[nodiscard]] std::filesystem::path part_name(const std::filesystem::path& output);

/// Waits until the file or directory is on the disk. thread: any
[[nodiscard]] Status sync_to_disk(const std::filesystem::path& path);

/// Gives `part` the name `output`, replacing a file of that name in one step, and makes that last. thread: any
[[nodiscard]] Status take_name(const std::filesystem::path& part, const std::filesystem::path& output);

/// The directory that `output` is in. thread: any
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& output);

}  // namespace terrella
