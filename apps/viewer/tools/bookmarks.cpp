#include "apps/viewer/tools/bookmarks.h"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "apps/process/user_folder.h"
#include "apps/viewer/bodies/body_names.h"
#include "apps/viewer/panels/readout.h"
#include "apps/viewer/tools/kept_json.h"
#include "geo/body.h"

namespace terrella {
namespace {

constexpr const char* kField = "bookmarks";
constexpr const char* kNames = "names";
constexpr const char* kPlaces = "places";

/// The text of a number in a field of the file; empty if there is none.
std::string text_in(const nlohmann::json& file, const char* field, const std::string& number) {
  const auto texts = file.find(field);
  if (texts == file.end() || !texts->is_object()) return {};
  const auto text = texts->find(number);
  return text != texts->end() && text->is_string() ? text->get<std::string>() : std::string();
}

}  // namespace

Result<Bookmarks> Bookmarks::load(const std::filesystem::path& file) {
  Bookmarks bookmarks;
  const Result<nlohmann::json> json = read_kept_json(file);
  if (!json) return json.error();
  if (json->is_null()) return bookmarks;
  const auto kept = json->find(kField);
  if (kept == json->end() || !kept->is_object()) return Error{file.string() + ": not a file of bookmarks"};
  for (int number = 1; number <= kMost; ++number) {
    const auto found = kept->find(std::to_string(number));
    if (found == kept->end() || !found->is_string()) continue;
    const Result<Camera> camera = parse_camera(found->get<std::string>());
    if (!camera) continue;
    bookmarks.bookmarks_[number] = {
        .camera = *camera, .name = text_in(*json, kNames, found.key()), .place = text_in(*json, kPlaces, found.key())};
  }
  return bookmarks;
}

Status Bookmarks::save(const std::filesystem::path& file) const {
  nlohmann::json cameras = nlohmann::json::object(), names = cameras, places = cameras;
  for (const auto& [number, bookmark] : bookmarks_) {
    cameras[std::to_string(number)] = camera_text(bookmark.camera);
    if (!bookmark.name.empty()) names[std::to_string(number)] = bookmark.name;
    if (!bookmark.place.empty()) places[std::to_string(number)] = bookmark.place;
  }
  const nlohmann::json json{{kField, cameras}, {kNames, names}, {kPlaces, places}};
  return write_kept_json(file, json);
}

std::optional<Camera> Bookmarks::at(int number) const {
  const auto found = bookmarks_.find(number);
  return found == bookmarks_.end() ? std::nullopt : std::optional(found->second.camera);
}

void Bookmarks::set(int number, const Camera& camera, std::string place) {
  Bookmark& bookmark = bookmarks_[number];
  bookmark.camera = camera;
  bookmark.place = std::move(place);
}

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

std::optional<std::filesystem::path> bookmarks_file(const std::string& body) {
  const auto folder = user_folder("XDG_CONFIG_HOME", ".config");
  if (!folder) return {};
  return *folder / (body == earth().name ? "bookmarks.json" : "bookmarks-" + body_file_word(body) + ".json");
}

}  // namespace terrella
