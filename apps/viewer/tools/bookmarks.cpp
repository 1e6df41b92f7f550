#include "apps/viewer/tools/bookmarks.h"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "apps/process/user_folder.h"
#include "apps/viewer/panels/readout.h"
#include "apps/viewer/tools/kept_json.h"

namespace terrella {
namespace {

constexpr const char* kField = "bookmarks";
constexpr const char* kNames = "names";

}  // namespace

Result<Bookmarks> Bookmarks::load(const std::filesystem::path& file) {
  Bookmarks bookmarks;
  const Result<nlohmann::json> json = read_kept_json(file);
  if (!json) return json.error();
  if (json->is_null()) return bookmarks;
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
  const nlohmann::json json{{kField, cameras}, {kNames, names}};
  return write_kept_json(file, json);
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
