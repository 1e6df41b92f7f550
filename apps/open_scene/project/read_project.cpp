#include "apps/open_scene/project/read_project.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <utility>

#include "apps/open_scene/options/number_options.h"
#include "apps/open_scene/options/place_options.h"
#include "apps/open_scene/options/remote_set_options.h"
#include "apps/open_scene/project/project_words.h"
#include "apps/process/data_dir.h"
#include "globe/features/point_clusters.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"
#include "streaming/objects/feature_style.h"
#include "streaming/sets/elevation_json.h"

namespace terrella {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kMostProjectBytes = 16UL << 20;
constexpr std::size_t kMostLayers = 10000;

/// A fault of a project: thrown where it is found, and caught by read().
struct ProjectFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The project that is being read.
struct Reader {
  std::string file;
  fs::path folder;

  [[noreturn]] void fail(const std::string& why) const { throw ProjectFault(file + ": " + why); }
};

bool is_among(std::span<const char* const> names, const std::string& name) {
  return std::ranges::any_of(names, [&name](const char* one) { return name == one; });
}

/// The text of an option's value.
std::string value_text(const Reader& reader, const std::string& name, const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number()) return value.dump();
  reader.fail(fmt::format("\"{}\" takes a text, a number, true or false", name));
}

/// Adds an entry as words of a command line.
void add_words(const Reader& reader, const std::string& name, const Json& value, std::vector<std::string>& words) {
  if (!value.is_array()) return words.push_back("--" + name + "=" + value_text(reader, name, value));
  for (const Json& one : value) words.push_back("--" + name + "=" + value_text(reader, name, one));
}

/// Lets the options of a command read the words, with the checks and the messages of the command line.
void parse_words(const Reader& reader, CLI::App& command, std::vector<std::string> words) {
  try {
    std::ranges::reverse(words);  // as CLI11 takes them
    command.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    reader.fail(error.what());
  }
}

void read_settings(const Reader& reader, const Json& settings, const CLI::App* given, SceneOptions& options) {
  if (!settings.is_object()) reader.fail("\"settings\" is no object");
  std::vector<std::string> words;
  for (const auto& [name, value] : settings.items()) {
    if (!is_among(kSettingNames, name)) reader.fail(fmt::format("there is no setting \"{}\"", name));
    if (given != nullptr && given->count("--" + name) > 0) continue;
    const bool is_file = name == "places" && value.is_string();
    add_words(reader, name, is_file ? Json(found_from(value.get<std::string>(), reader.folder)) : value, words);
  }
  CLI::App command;
  add_scene_options(command, options);
  parse_words(reader, command, std::move(words));
}

std::string source_of(const Reader& reader, JsonFields& fields, bool needed) {
  const std::string source = fields.text(kSource);
  if (source.empty() && needed) fields.fail<int>(kSource, "is missing");
  return found_from(source, reader.folder);
}

void read_look(JsonFields& fields, bool& shown, double& opacity) {
  shown = fields.flag(kShown, shown);
  if (fields.has(kOpacity)) opacity = fields.number(kOpacity);
  if (!(opacity >= 0.0 && opacity <= 1.0)) opacity = fields.fail<double>(kOpacity, "takes 0 to 1");
}

template <class Value>
void read_word(JsonFields& fields, const char* name, const OptionWords<Value>& words, Value& value) {
  if (!fields.has(name)) return;
  const std::string text = fields.text(name);
  const auto known = std::ranges::find(words, text, &std::pair<std::string, Value>::first);
  known != words.end() ? value = known->second : fields.fail<Value>(name, "has no value \"" + text + "\"");
}

void keep_or_throw(const JsonFields& fields) {
  if (fields.error()) throw ProjectFault(fields.error()->message);
}

LayerOption read_image(const Reader& reader, const Json& layer, const std::string& where) {
  LayerOption image;
  JsonFields fields(layer, where);
  image.source.address = source_of(reader, fields, false);
  read_look(fields, image.look.shown, image.look.opacity);
  image.source.other_body = fields.flag(kOtherBody, false);
  if (fields.has(kTitle)) image.source.remote.name = fields.text(kTitle);
  if (fields.has(kAttribution)) image.source.remote.attribution = fields.text(kAttribution);
  read_word(fields, kDaylight, daylight_words(), image.look.daylight);
  read_word(fields, kAlpha, alpha_words(), image.look.alpha);
  read_word(fields, kLayerBlend, layer_blend_words(), image.look.blend);
  if (fields.has(kBrightness)) image.look.tone.brightness = fields.number(kBrightness);
  if (fields.has(kContrast)) image.look.tone.contrast = fields.number(kContrast);
  if (fields.has(kGamma)) image.look.tone.gamma = fields.number(kGamma);
  read_word(fields, kSwipe, swipe_words(), image.look.swipe);
  read_word(fields, kClock, clock_words(), image.look.clock);
  if (fields.has(kHeight)) image.look.height_m = fields.number(kHeight);
  keep_or_throw(fields);
  if (const Status sane = check_look(image.look); !sane) reader.fail(sane.error().message);
  std::vector<std::string> words;
  for (const auto& [name, value] : layer.items()) {
    constexpr std::array kOwn = {kKind,      kSource, kShown,       kOpacity,    kDaylight, kAlpha,
                                 kHeight,    kSwipe,  kLayerBlend,  kBrightness, kContrast, kGamma,
                                 kOtherBody, kTitle,  kAttribution, kClock};
    if (is_among(kOwn, name)) continue;
    if (!is_among(kSourceNames, name)) throw ProjectFault(fmt::format("{}: there is no field \"{}\"", where, name));
    const bool file = name == "colormap" && value.is_string() && !has_named_map(value.get<std::string>());
    add_words(reader, name, file ? Json(found_from(value.get<std::string>(), reader.folder)) : value, words);
  }
  CLI::App command;
  double pole_band = 0.0;
  add_row_options(command, image.source);
  add_place_options(command, image.source.place);
  add_number_options(command, image.source.numbers, pole_band);
  add_remote_set_options(command, image.source.remote);
  parse_words({.file = where, .folder = reader.folder}, command, std::move(words));
  return image;
}

void read_heights(const Reader& reader, const Json& layer, const std::string& where, SceneOptions& options) {
  JsonFields fields(layer, where);
  constexpr std::array kKnown = {kKind, kSource, kShown, kEncoding};
  fields.refuse_others(kKnown);
  try {
    options.elevation = fields.has(kSource) ? Url(source_of(reader, fields, true)) : included_relief();
  } catch (const BrokenInstallation& broken) {
    throw ProjectFault(fmt::format("{}: {}", where, broken.what()));
  }
  double opacity = 1.0;
  read_look(fields, options.elevation_shown, opacity);
  if (const std::string name = fields.text(kEncoding); !name.empty()) {
    options.elevation_encoding = rgb_encoding(name);
    if (!options.elevation_encoding) fields.fail<int>(kEncoding, "takes terrain-rgb or terrarium");
  }
  keep_or_throw(fields);
}

ObjectsOption read_object_layer(const Reader& reader, const Json& layer, const std::string& where) {
  JsonFields fields(layer, where);
  constexpr std::array kKnown = {kKind, kSource, kShown, kOpacity, kStyle, kStyleOver, kPlace, kCluster};
  fields.refuse_others(kKnown);
  ObjectsOption objects{.file = source_of(reader, fields, true)};
  if (fields.has(kStyle)) objects.style = found_from(fields.text(kStyle), reader.folder);
  if (const auto at = layer.find(kStyleOver); at != layer.end()) {
    objects.style_over = at->dump();
    const Result<FeatureStyle> sane = FeatureStyle::parse(objects.style_over, where + ": \"classes\"");
    if (!sane) throw ProjectFault(sane.error().message);
  }
  read_look(fields, objects.shown, objects.opacity);
  if (fields.has(kCluster)) {
    objects.cluster_px = fields.number(kCluster);
    const bool sane =
        PointClusters::kLeastRadius_px <= objects.cluster_px && objects.cluster_px <= PointClusters::kMostRadius_px;
    if (!sane) throw ProjectFault(where + ": the field \"cluster\" takes 10 to 400 pixels");
  }
  if (const auto at = layer.find(kPlace); at != layer.end()) {
    const bool sane = at->is_array() && at->size() == 3 &&
                      std::ranges::all_of(*at, [](const Json& number) { return number.is_number(); });
    if (!sane) throw ProjectFault(where + ": the field \"place\" takes [latitude, longitude, height in metres]");
    objects.model_place = Geodetic{.lat = Angle::degrees((*at)[0].get<double>()),
                                   .lon = Angle::degrees((*at)[1].get<double>()),
                                   .height_m = (*at)[2].get<double>()};
  }
  if (fields.text(kKind) == kModel && !objects.model_place) fields.fail<int>(kPlace, "is missing");
  keep_or_throw(fields);
  return objects;
}

void read_layers(const Reader& reader, const Json& layers, const CLI::App* given, SceneOptions& options) {
  if (!layers.is_array() || layers.size() > kMostLayers) reader.fail("\"layers\" is no list of layers");
  std::vector<LayerOption> images;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::string where = fmt::format("{}: layer {}", reader.file, i + 1);
    if (!layers[i].is_object()) throw ProjectFault(where + " is no object");
    JsonFields fields(layers[i], where);
    const std::string kind = fields.text(kKind);
    keep_or_throw(fields);
    if (kind == kImagery) {
      images.push_back(read_image(reader, layers[i], where));
    } else if (kind == kObjects || kind == kModel) {
      options.object_layers.push_back(read_object_layer(reader, layers[i], where));
    } else if (kind != kHeights) {
      throw ProjectFault(
          fmt::format("{}: there is no kind \"{}\"; the kinds are heights, imagery, objects, model", where, kind));
    } else if (given == nullptr || given->count("--elevation") + given->count("--relief") == 0) {
      read_heights(reader, layers[i], where, options);
    }
  }
  set_images(options, std::move(images));
}

/// Options about one TILESET cannot count for the layers of a project.
void refuse_source_options(const Reader& reader, const CLI::App& given) {
  for (const char* name : kSourceNames) {
    const std::string option = std::string("--") + name;
    const CLI::Option* known = given.get_option_no_throw(option);
    if (known != nullptr && known->count() > 0)
      reader.fail(option + " is about one picture or server; in a project each layer says it for itself");
  }
}

void read_file_into(const Reader& reader, const CLI::App* given, SceneOptions& options) {
  const auto bytes = read_file(reader.file, kMostProjectBytes);
  if (!bytes) throw ProjectFault(bytes.error().message);
  const Result<Json> parsed = parse_json_object(as_text(*bytes), kMostProjectBytes, reader.file);
  if (!parsed) throw ProjectFault(parsed.error().message);
  const Json& json = *parsed;
  const auto version = json.find(kVersion);
  if (version == json.end() || !version->is_number_integer()) {
    reader.fail("this is no project: it has no field \"terrella\" with the version of the format");
  }
  if (*version != kProjectVersion) {
    reader.fail(fmt::format("its format has version {}, and this program reads version {}; a newer terrella reads it",
                            version->dump(), kProjectVersion));
  }
  for (const auto& [name, value] : json.items()) {
    constexpr std::array kKnown = {kVersion, kSettings, kLayers, kDrawings};
    if (!is_among(kKnown, name)) reader.fail(fmt::format("there is no field \"{}\"", name));
  }
  options.base.address = {};
  options.project = reader.file;
  options.leave_out_faulty = true;
  if (given != nullptr) refuse_source_options(reader, *given);
  if (json.contains(kSettings)) read_settings(reader, json[kSettings], given, options);
  if (json.contains(kDrawings)) options.drawings = json[kDrawings].dump();
  read_layers(reader, json.contains(kLayers) ? json[kLayers] : Json::array(), given, options);
}

Status read(const fs::path& file, const CLI::App* given, SceneOptions& options) {
  SceneOptions read = options;
  try {
    read_file_into({.file = file.string(), .folder = file.parent_path()}, given, read);
  } catch (const ProjectFault& fault) {
    return Error{fault.what()};
  }
  options = std::move(read);
  return Done{};
}

}  // namespace

Status read_project(const CLI::App& command, SceneOptions& options) {
  return read(options.base.address.with_secrets(), &command, options);
}

Status read_project(const fs::path& file, SceneOptions& options) { return read(file, nullptr, options); }

Result<LayerOption> read_image_layer(const Json& layer, const fs::path& folder, const std::string& where) {
  try {
    return read_image({.file = where, .folder = folder}, layer, where);
  } catch (const ProjectFault& fault) {
    return Error{fault.what()};
  }
}

}  // namespace terrella
