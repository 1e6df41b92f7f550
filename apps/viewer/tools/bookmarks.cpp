#include "apps/viewer/tools/bookmarks.h"

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <system_error>

#include "apps/setup/user_folder.h"
#include "apps/setup/write_file.h"
#include "apps/viewer/panels/readout.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"

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
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const Result<nlohmann::json> json = parse_json_object(text, kMostBookmarkBytes, file.string());
  if (!json) return json.error();
  const auto kept = json->find(kField);
  if (kept == json->end() || !kept->is_object()) return Error{file.string() + ": not a file of bookmarks"};
  for (int number = 1; number <= kMost; ++number) {
    const auto found = kept->find(std::to_string(number));
    if (found == kept->end() || !found->is_string()) continue;
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
  const auto folder = user_folder("XDG_CONFIG_HOME", ".config");
  return folder ? std::optional(*folder / "bookmarks.json") : std::nullopt;
}

}  // namespace terrella
