#include "apps/viewer/catalogue/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>

#include "apps/open_scene/project/read_project.h"
#include "apps/process/data_dir.h"
#include "apps/process/user_folder.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"
#include "streaming/remote/url_template.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kVersion = 1;
constexpr std::size_t kMostBytes = 1UL << 20;
// Fields that an image layer of a project does not have.
constexpr const char *kBody = "body", *kTheme = "theme", *kLicence = "licence", *kFacts = "facts", *kDates = "dates";

std::string needed_text(JsonFields& fields, const char* name) {
  std::string text = fields.text(name);
  if (text.empty()) fields.fail<int>(name, "is missing");
  return text;
}

/// Checks the scheme of an address, and a URL template as its first request would.
Status check_address(const SourceOptions& said, const std::string& where) {
  const std::string& text = said.address.with_secrets();
  constexpr std::array kSchemes = {"http", "https", "file"};
  const std::size_t colon = text.find("://");
  if (colon == text.npos) return Done{};  // a path
  if (std::ranges::find(kSchemes, text.substr(0, colon)) == kSchemes.end())
    return Error{fmt::format("{}: the field \"source\" is no address of http, https or file", where)};
  if (text.find('{') == text.npos) return Done{};
  const auto set = template_tile_set(said.address, said.remote, true, where);
  return set ? Status(Done{}) : set.error();
}

Result<CatalogueEntry> read_entry(const Json& json, const fs::path& folder, const std::string& where) {
  if (!json.is_object()) return Error{where + " is no object"};
  JsonFields fields(json, where);
  CatalogueEntry entry{.title = needed_text(fields, "title"),
                       .theme = needed_text(fields, kTheme),
                       .licence = needed_text(fields, kLicence)};
  for (const char* name : {"source", "attribution", kBody}) (void)needed_text(fields, name);
  if (!fields.has("max-level")) fields.fail<int>("max-level", "is missing");
  entry.has_dates = fields.flag(kDates, false);
  if (fields.error()) return *fields.error();
  auto body = parse_body(fields.text(kBody));
  if (!body) return Error{fmt::format("{}: {}", where, body.error().message)};
  entry.body = *std::move(body);
  Json layer = json;
  for (const char* name : {kBody, kTheme, kLicence, kFacts, kDates}) layer.erase(name);
  auto image = read_image_layer(layer, folder, where);
  if (!image) return image.error();
  entry.said = std::move(image->source);
  if (Status good = check_address(entry.said, where); !good) return good.error();
  entry.has_dates = entry.has_dates || !entry.said.remote.times.empty();
  return entry;
}

/// Name of an entry in messages: its number and its title.
std::string entry_name(const Json& json, std::size_t number) {
  const bool titled = json.is_object() && json.contains("title") && json["title"].is_string();
  return titled ? fmt::format("entry {}, \"{}\"", number, json["title"].get<std::string>())
                : fmt::format("entry {}", number);
}

void add(Catalogue& to, Catalogue more) {
  std::ranges::move(more.entries, std::back_inserter(to.entries));
  std::ranges::move(more.complaints, std::back_inserter(to.complaints));
}

Catalogue read_catalogue_file(const fs::path& file) {
  const auto bytes = read_file(file, kMostBytes);
  if (!bytes) return {.entries = {}, .complaints = {bytes.error().message}};
  return parse_catalogue(as_text(*bytes), file.parent_path(), file.string());
}

}  // namespace

Catalogue parse_catalogue(std::string_view text, const fs::path& folder, const std::string& where) {
  Catalogue catalogue;
  const auto complain = [&catalogue](const std::string& why) { catalogue.complaints.push_back(why); };
  const Result<Json> parsed = parse_json_object(text, kMostBytes, where);
  if (!parsed) return complain(parsed.error().message), catalogue;
  const Json& json = *parsed;
  JsonFields fields(json, where);
  constexpr std::array kKnown = {"catalogue", "entries"};
  fields.refuse_others(kKnown);
  if (fields.integer("catalogue", std::nullopt) != kVersion) fields.fail<int>("catalogue", "is not 1, the version");
  const auto entries = json.find("entries");
  if (entries == json.end() || !entries->is_array()) fields.fail<int>("entries", "is no list");
  if (fields.error()) return complain(fields.error()->message), catalogue;
  for (std::size_t i = 0; i < entries->size(); ++i) {
    auto entry = read_entry((*entries)[i], folder, fmt::format("{}: {}", where, entry_name((*entries)[i], i + 1)));
    entry ? catalogue.entries.push_back(*std::move(entry)) : complain(entry.error().message);
  }
  return catalogue;
}

Catalogue load_catalogue() {
  Catalogue all;
  try {
    all = read_catalogue_file(data_file("catalogue.json"));
  } catch (const BrokenInstallation& broken) {
    all.complaints.emplace_back(broken.what());
  }
  const auto folder = user_folder("XDG_CONFIG_HOME", ".config");
  std::error_code failed;
  if (folder && fs::status(*folder / "catalogue.json", failed).type() != fs::file_type::not_found) {
    add(all, read_catalogue_file(*folder / "catalogue.json"));
  }
  return all;
}

}  // namespace terrella
