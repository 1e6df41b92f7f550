#include "apps/viewer/tools/bookmarks.h"

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include "apps/setup/user_folder.h"
#include "apps/setup/write_file.h"
#include "apps/viewer/panels/readout.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"

namespace terrella {
namespace {

constexpr std::size_t kMostBookmarkBytes = 1UL << 20;
constexpr const char* kField = "bookmarks";
constexpr const char* kNames = "names";

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
  const auto names = json->find(kNames);
  for (int number = 1; number <= kMost; ++number) {
    const auto found = kept->find(std::to_string(number));
    if (found == kept->end() || !found->is_string()) continue;
    const Result<Camera> camera = parse_camera(found->get<std::string>());
    if (!camera) continue;
    bookmarks.set(number, *camera);
    if (names == json->end() || !names->is_object()) continue;
    const auto name = names->find(found.key());
    if (name != names->end() && name->is_string()) bookmarks.rename(number, name->get<std::string>());
  }
  return bookmarks;
}

Status Bookmarks::save(const std::filesystem::path& file) const {
  nlohmann::json cameras = nlohmann::json::object(), names = nlohmann::json::object();
  for (const auto& [number, bookmark] : bookmarks_) {
    cameras[std::to_string(number)] = camera_text(bookmark.camera);
    if (!bookmark.name.empty()) names[std::to_string(number)] = bookmark.name;
  }
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (failed) return Error{file.parent_path().string() + ": " + failed.message()};
  const nlohmann::json json{{kField, cameras}, {kNames, names}};
  const std::string text = json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  return write_file(file, std::as_bytes(std::span(text)));
}

std::optional<Camera> Bookmarks::at(int number) const {
  const auto found = bookmarks_.find(number);
  return found == bookmarks_.end() ? std::nullopt : std::optional(found->second.camera);
}

void Bookmarks::set(int number, const Camera& camera) { bookmarks_[number].camera = camera; }

void Bookmarks::rename(int number, std::string name) {
  const auto found = bookmarks_.find(number);
  if (found != bookmarks_.end()) found->second.name = std::move(name);
}

void Bookmarks::exchange(int number, int other) {
  auto one = bookmarks_.extract(number), two = bookmarks_.extract(other);
  if (one) one.key() = other;
  if (two) two.key() = number;
  if (one) bookmarks_.insert(std::move(one));
  if (two) bookmarks_.insert(std::move(two));
}

std::optional<int> Bookmarks::free_number() const {
  for (int number = 1; number <= kMost; ++number) {
    if (!bookmarks_.contains(number)) return number;
  }
  return {};
}

std::optional<std::filesystem::path> bookmarks_file() {
  const auto folder = user_folder("XDG_CONFIG_HOME", ".config");
  return folder ? std::optional(*folder / "bookmarks.json") : std::nullopt;
}

}  // namespace terrella
