#include "apps/process/data_dir.h"

#include <fmt/core.h>

#include <cstdlib>
#include <utility>

namespace terrella {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> g_folders;  // empty: those of the program

std::vector<fs::path> data_folders() {
  if (const char* chosen = std::getenv("TERRELLA_DATA"); chosen != nullptr && *chosen != '\0') return {chosen};
  if (!g_folders.empty()) return g_folders;
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  if (failed) return {};
  const fs::path folder = program.parent_path();
  return {folder / "data", folder.parent_path() / "share" / "terrella"};
}

}  // namespace

void set_data_folders(std::vector<fs::path> folders) { g_folders = std::move(folders); }

fs::path data_file(std::string_view name) {
  std::string tried;
  for (const fs::path& folder : data_folders()) {
    fs::path candidate = folder / name;
    std::error_code failed;
    if (fs::is_regular_file(candidate, failed)) return candidate;
    tried += fmt::format("\n  {}", candidate.string());
  }
  throw BrokenInstallation(fmt::format(
      "the installation lacks {}; looked for{}\nBuild or install it again, or name its folder in TERRELLA_DATA.", name,
      tried));
}

}  // namespace terrella
