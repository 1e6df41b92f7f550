#include "apps/viewer/bookmarks.h"

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <system_error>

#include "apps/viewer/readout.h"
#include "apps/write_file.h"
#include "streaming/file_bytes.h"

namespace terrella {
namespace {

constexpr std::size_t kMostBookmarkBytes = 1UL << 20;
constexpr const char* kField = "bookmarks";

}  // namespace

Result<Bookmarks> Bookmarks::load(const std::filesystem::path& file) {
  Bookmarks bookmarks;
  const auto bytes = read_file(file, kMostBookmarkBytes);
  if (!bytes && bytes.error().problem == FileProblem::missing) return bookmarks;
  if (!bytes) return Error{bytes.error().message};
  const auto* text = reinterpret_cast<const char*>(bytes->data());
  const nlohmann::json json = nlohmann::json::parse(text, text + bytes->size(), nullptr, false);
  if (!json.is_object() || !json.contains(kField) || !json[kField].is_object()) {
    return Error{file.string() + ": no file of bookmarks"};
  }
  for (int number = 1; number <= kMost; ++number) {
    const auto found = json[kField].find(std::to_string(number));
    if (found == json[kField].end() || !found->is_string()) continue;
    const Result<Camera> camera = parse_camera(found->get<std::string>());
    if (camera) bookmarks.set(number, *camera);
  }
  return bookmarks;
}

Status Bookmarks::save(const std::filesystem::path& file) const {
  nlohmann::json cameras = nlohmann::json::object();
  for (int number = 1; number <= kMost; ++number) {
    if (at(number)) cameras[std::to_string(number)] = camera_text(*at(number));
  }
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (failed) return Error{file.parent_path().string() + ": " + failed.message()};
  const std::string text = nlohmann::json{{kField, cameras}}.dump(2) + "\n";
  return write_file(file, std::as_bytes(std::span(text)));
}

std::optional<std::filesystem::path> bookmarks_file() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  if (config != nullptr && *config == '/') return std::filesystem::path(config) / "terrella" / "bookmarks.json";
  if (home != nullptr && *home == '/') return std::filesystem::path(home) / ".config" / "terrella" / "bookmarks.json";
  return {};
}

}  // namespace terrella
