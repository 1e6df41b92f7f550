#include "apps/open_scene/project/project_paths.h"

#include <algorithm>
#include <cctype>
#include <system_error>

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kProjectEnding = ".terrella";

fs::path absolute_path(const fs::path& path) {
  std::error_code failed;
  const fs::path whole = fs::absolute(path, failed);
  return (failed ? path : whole).lexically_normal();
}

}  // namespace

bool is_project(const std::string& source) { return is_path(source) && source.ends_with(kProjectEnding); }

bool is_path(const std::string& source) {
  const std::size_t colon = source.find(':');
  if (source.empty() || colon == std::string::npos) return !source.empty();
  const auto of_a_name = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '+' || c == '-'; };
  const bool names_driver =
      colon > 1 && std::all_of(source.begin(), source.begin() + static_cast<std::ptrdiff_t>(colon), of_a_name);
  return !names_driver;
}

std::string seen_from(const std::string& source, const fs::path& folder) {
  if (!is_path(source)) return source;
  const fs::path whole = absolute_path(source);
  if (folder.empty()) return whole.string();
  const fs::path relative = whole.lexically_relative(absolute_path(folder));
  return (relative.empty() ? whole : relative).string();
}

std::string found_from(const std::string& source, const fs::path& folder) {
  return is_path(source) ? (folder / source).lexically_normal().string() : source;
}

}  // namespace terrella
