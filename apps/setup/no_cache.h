#pragma once

#include <filesystem>

#include "base/result.h"

namespace terrella {

/// Says on standard error, the first time it is called, why nothing can be kept and that the program goes on without a
/// cache. Later calls say nothing. thread: any
void say_without_cache(const Error& why);

/// True if a file can be made in the folder, which is made if it is not there. thread: any
[[nodiscard]] bool can_write_into(const std::filesystem::path& folder);

}  // namespace terrella
