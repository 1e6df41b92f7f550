#include "apps/viewer/tools/kept_settings.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/setup/scene_options.h"
#include "apps/setup/user_folder.h"
#include "apps/setup/write_file.h"
#include "streaming/file_bytes.h"

namespace terrella {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kMostSettingsBytes = 1UL << 20;

/// Reads fields one by one and keeps the first fault.
class FieldReader {
 public:
  explicit FieldReader(const Json& json) : json_(json) {}
  void read(const char* name, bool& value) {
    if (const Json* field = find(name)) field->is_boolean() ? void(value = field->get<bool>()) : complain(name);
  }
  void read(const char* name, int& value) {
    const Json* field = find(name);
    if (field == nullptr) return;
    const std::int64_t number = field->is_number_integer() ? field->get<std::int64_t>() : -1;
    number >= 0 && number <= kMaxSide_px ? void(value = int(number)) : complain(name);
  }
  [[nodiscard]] const std::string& wrong() const { return wrong_; }

 private:
  [[nodiscard]] const Json* find(const char* name) const {
    const auto found = json_.find(name);
    return found == json_.end() ? nullptr : &*found;
  }
  void complain(const char* name) {
    if (wrong_.empty()) wrong_ = name;
  }
  const Json& json_;
  std::string wrong_;
};

Json parsed(const std::vector<std::byte>& bytes) {
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  return Json::parse(text, text + bytes.size(), nullptr, false);
}

std::string set_aside(const std::filesystem::path& file, const std::string& what) {
  std::filesystem::path copy = file;
  copy += ".damaged";
  std::error_code failed;
  std::filesystem::copy_file(file, copy, std::filesystem::copy_options::overwrite_existing, failed);
  return fmt::format("{}: {}; it counts as if it were not there{}", file.string(), what,
                     failed ? "" : ", and a copy is kept in " + copy.filename().string());
}

}  // namespace

LoadedSettings load_settings(const std::filesystem::path& file) {
  LoadedSettings loaded;
  const auto bytes = read_file(file, kMostSettingsBytes);
  if (!bytes && bytes.error().problem == FileProblem::missing)
    return {.settings = {}, .first_run = true, .complaint = {}};
  if (!bytes) return {.settings = {}, .first_run = false, .complaint = bytes.error().message};
  const Json json = parsed(*bytes);
  if (!json.is_object()) {
    loaded.complaint = set_aside(file, "no file of settings");
    return loaded;
  }
  FieldReader reader(json);
  KeptSettings& settings = loaded.settings;
  reader.read("width", settings.width_px);
  reader.read("height", settings.height_px);
  reader.read("panel", settings.panel);
  reader.read("layers", settings.layers);
  reader.read("graticule", settings.graticule);
  if (!reader.wrong().empty()) loaded.complaint = set_aside(file, "\"" + reader.wrong() + "\" is out of its range");
  return loaded;
}

Status save_settings(const std::filesystem::path& file, const KeptSettings& settings) {
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (failed) return Error{file.parent_path().string() + ": " + failed.message()};
  Json json = Json::object();
  if (const auto bytes = read_file(file, kMostSettingsBytes)) {
    Json before = parsed(*bytes);
    if (before.is_object()) json = std::move(before);
  }
  json["width"] = settings.width_px;
  json["height"] = settings.height_px;
  json["panel"] = settings.panel;
  json["layers"] = settings.layers;
  json["graticule"] = settings.graticule;
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return write_file(file, std::as_bytes(std::span(text)));
}

KeptSettings changed_since(KeptSettings kept, const KeptSettings& start, const KeptSettings& now) {
  const auto take = [&](auto field) {
    if (start.*field != now.*field) kept.*field = now.*field;
  };
  take(&KeptSettings::width_px);
  take(&KeptSettings::height_px);
  take(&KeptSettings::panel);
  take(&KeptSettings::layers);
  take(&KeptSettings::graticule);
  return kept;
}

std::optional<std::filesystem::path> settings_file() {
  const auto folder = user_folder("XDG_CONFIG_HOME", ".config");
  if (!folder) return {};
  return *folder / "settings.json";
}

}  // namespace terrella
