#pragma once

#include <filesystem>
#include <optional>

namespace terrella {

/// Returns the user's folder for Terrella by the XDG base directory specification. $VARIABLE/terrella applies if the
/// variable holds an absolute path; relative paths are ignored. Otherwise the folder is ~/`below_home`/terrella, or
/// nullopt without HOME. The folder need not exist. thread: any, while nobody changes the environment
[[nodiscard]] std::optional<std::filesystem::path> user_folder(const char* variable, const char* below_home);

}  // namespace terrella
