#pragma once

#include <filesystem>
#include <optional>

namespace terrella {

/// The user's folder for Terrella by the XDG base directory specification: $VARIABLE/terrella, where that names an
/// absolute path (a relative one is to be ignored), or else ~/`below_home`/terrella; nothing where HOME is not set
/// either. It need not be there. thread: any, while nobody changes the environment
[[nodiscard]] std::optional<std::filesystem::path> user_folder(const char* variable, const char* below_home);

}  // namespace terrella
