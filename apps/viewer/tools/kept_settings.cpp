#include "apps/viewer/tools/kept_settings.h"

#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "apps/open_scene/options/scene_options.h"
#include "apps/process/user_folder.h"
#include "apps/viewer/tools/kept_json.h"
#include "streaming/file_bytes.h"

namespace terrella {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kMostSettingsBytes = 1UL << 20;

/// Calls `visit` with the name and the member of each setting.
template <class Visit>
void for_each_setting(Visit visit) {
  visit("width", &KeptSettings::width_px);
  visit("height", &KeptSettings::height_px);
  visit("panel", &KeptSettings::panel);
  visit("layers", &KeptSettings::layers);
  visit("graticule", &KeptSettings::graticule);
  visit("map", &KeptSettings::map);
  visit("restore", &KeptSettings::restore);
  visit("units", &KeptSettings::units);
}

bool read_field(const Json& field, bool& value) {
  if (field.is_boolean()) value = field.get<bool>();
  return field.is_boolean();
}

bool read_field(const Json& field, int& value) {
  const std::int64_t number = field.is_number_integer() ? field.get<std::int64_t>() : -1;
  if (number < 0 || number > kMaxSide_px) return false;
  value = int(number);
  return true;
}

bool read_field(const Json& field, LengthUnits& value) {
  int number = 0;
  if (!read_field(field, number) || number > int(LengthUnits::nautical)) return false;
  value = LengthUnits(number);
  return true;
}

Json parsed(const std::vector<std::byte>& bytes) {
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  return Json::parse(text, text + bytes.size(), nullptr, false);
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
    loaded.complaint = set_aside(file, file.string() + ": not a file of settings");
    return loaded;
  }
  std::string wrong;
  for_each_setting([&](const char* name, auto member) {
    const auto field = json.find(name);
    if (field != json.end() && !read_field(*field, loaded.settings.*member) && wrong.empty()) wrong = name;
  });
  if (!wrong.empty()) loaded.complaint = set_aside(file, file.string() + ": \"" + wrong + "\" is out of its range");
  return loaded;
}

Status save_settings(const std::filesystem::path& file, const KeptSettings& settings) {
  Json json = Json::object();
  if (const auto bytes = read_file(file, kMostSettingsBytes)) {
    Json before = parsed(*bytes);
    if (before.is_object()) json = std::move(before);
  }
  for_each_setting([&](const char* name, auto member) { json[name] = settings.*member; });
  return write_kept_json(file, json);
}

KeptSettings changed_since(KeptSettings kept, const KeptSettings& start, const KeptSettings& now) {
  for_each_setting([&](const char*, auto member) {
    if (start.*member != now.*member) kept.*member = now.*member;
  });
  return kept;
}

std::optional<std::filesystem::path> settings_file() {
  const auto folder = user_folder("XDG_CONFIG_HOME", ".config");
  if (!folder) return {};
  return *folder / "settings.json";
}

}  // namespace terrella
