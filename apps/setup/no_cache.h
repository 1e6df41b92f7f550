#pragma once

#include <filesystem>

#include "base/result.h"

namespace terrella {

/// Reports on standard error, once per run, why the program continues without a cache. thread: any
void say_without_cache(const Error& why);

/// True if a file can be created in the folder; creates the folder if needed. thread: any
[[nodiscard]] bool can_write_into(const std::filesystem::path& folder);

}  // namespace terrella
