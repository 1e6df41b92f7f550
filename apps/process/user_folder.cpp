#include "apps/process/user_folder.h"

#include <cstdlib>

namespace terrella {

std::optional<std::filesystem::path> user_folder(const char* variable, const char* below_home) {
  const char* xdg = std::getenv(variable);
  if (xdg != nullptr && std::filesystem::path(xdg).is_absolute()) return std::filesystem::path(xdg) / "terrella";
  const char* home = std::getenv("HOME");
  if (home != nullptr && *home != '\0') return std::filesystem::path(home) / below_home / "terrella";
  return std::nullopt;
}

}  // namespace terrella
