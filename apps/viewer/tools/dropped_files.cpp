#include "apps/viewer/tools/dropped_files.h"

#include <GLFW/glfw3.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <string_view>
#include <utility>

#include "apps/open_scene/scene_objects.h"
#include "apps/process/console.h"
#include "streaming/file_bytes.h"
#include "streaming/georeference/figure.h"
#include "streaming/objects/vector_objects.h"
#include "streaming/url.h"

namespace terrella {
namespace {

constexpr std::size_t kGeoJsonHead = 4096;

// Tells GeoJSON from source descriptions, as both end in .json; only GeoJSON names its type.
bool is_geojson(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".geojson") return true;
  if (extension != ".json") return false;
  const auto bytes = read_head(path, kGeoJsonHead);
  if (!bytes) return false;
  const std::string_view head = as_text(*bytes);
  constexpr std::string_view kTypes[] = {"\"Feature",        "\"Point\"",           "\"LineString\"",
                                         "\"Polygon\"",      "\"MultiPoint",        "\"MultiLineString",
                                         "\"MultiPolygon\"", "\"GeometryCollection"};
  return std::ranges::any_of(kTypes, [head](std::string_view type) { return head.find(type) != head.npos; });
}

std::filesystem::path path_of(const SourceOptions& said) { return said.address.with_secrets(); }

Result<OpenedFile> open_objects(const SourceOptions& said, std::optional<Geodetic> model_place = {}) {
  auto file = read_object_layer({.file = said.address.with_secrets(), .model_place = model_place});
  if (!file) return file.error();
  return OpenedFile{said, *std::move(file), model_place};
}

/// True for a folder or file that may hold tiles or features, which only its content tells.
bool is_of_either(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  std::error_code unknown;
  return (extension == ".gpkg" || std::filesystem::is_directory(path, unknown)) && is_vector_file(path);
}

/// Numbers are the ground's heights if they say so.
bool is_of_heights(const TileSetInfo& info) {
  return info.numbers && (info.numbers->quantity == "height" || info.numbers->unit == "m");
}

/// Opens tiles as those of the body that they state themselves.
Result<std::shared_ptr<TileSource>> open_as_stated(SourceOptions options, const CutProgress& progress) {
  options.body.reset();
  return open_any_tiles(options, progress);
}

/// The body that a file's name has, if it is another one than the globe's.
std::optional<Body> other_by_name(const SourceOptions& said, const Body& globe) {
  const auto named = said.other_body ? std::nullopt : named_body(path_of(said));
  return named && are_two_bodies(*named, globe) ? named : std::nullopt;
}

/// Opens tiles for the globe's body, or finds that they state another one, `other`. The Earth's needs no word, so tiles
/// that open as the Earth's alone are of the Earth.
Result<std::shared_ptr<TileSource>> open_and_judge(const SourceOptions& options, const CutProgress& progress,
                                                   std::optional<Body>& other) {
  const Body globe = options.body.value_or(earth());
  const bool on_earth = globe.name == earth().name;
  if (options.other_body) return open_any_tiles(options, progress);
  auto tiles = on_earth ? open_as_stated(options, progress) : open_any_tiles(options, progress);
  if (bool(tiles) != on_earth) return tiles;
  auto stated = on_earth ? tiles : open_as_stated(options, progress);
  if (!stated) return tiles;
  const auto body = parse_body((*stated)->info().body.empty() ? earth().name : (*stated)->info().body);
  if (body && are_two_bodies(*body, globe)) other = *body;
  return other ? stated : tiles;
}

Result<OpenedFile> open_tiles(const SourceOptions& said, const SourceOptions& how, const CutProgress& progress) {
  SourceOptions tiles_options = with_words(options_beside(how, said.address), said);
  if (const auto named = other_by_name(said, how.body.value_or(earth()))) {
    return OpenedFile{
        .said = said, .what = {}, .other_body = OtherBodyFile{.said = said, .body = *named, .by_name = true}};
  }
  std::vector<std::shared_ptr<GrowingCut>> cuts;
  tiles_options.cuts = &cuts;
  OpenedRasters rasters;
  tiles_options.opened = &rasters;
  std::optional<Body> other;
  auto tiles = open_and_judge(tiles_options, progress, other);
  if (!tiles) return tiles.error();
  if (other) {
    const bool of_heights = is_of_heights((*tiles)->info());
    return OpenedFile{
        .said = said, .what = {}, .other_body = OtherBodyFile{.said = said, .body = *other, .of_heights = of_heights}};
  }
  const std::string name = said.address.redacted();
  FactsReader read_facts = facts_reader(tiles_options.address, {}, {}, rasters);
  if (!is_of_heights((*tiles)->info())) {
    auto layer = layer_of(*std::move(tiles), said.numbers, name, true);
    if (!layer) return layer.error();
    return OpenedFile{said, *std::move(layer), {}, std::move(cuts), std::move(read_facts)};
  }
  auto heights = ElevationSource::open(*std::move(tiles), name);
  if (!heights) return heights.error();
  return OpenedFile{said, *std::move(heights), {}, {}, std::move(read_facts)};
}

/// Opens the features of a vector file; of a KML file with its pictures, if it has some.
Result<OpenedFile> open_vector(const SourceOptions& said, const SourceOptions& how, const CutProgress& progress) {
  auto opened = open_objects(said);
  if (!opened) return opened.error();
  auto& features = std::get<ObjectFile>(opened->what);
  if (features.ground_overlays == 0) return opened;
  auto pictures = open_tiles(said, how, progress);
  if (!pictures && features.scene.empty()) return pictures.error();
  if (!pictures) {
    features.complaints.insert(features.complaints.begin(), pictures.error().message);
    return opened;
  }
  if (!features.scene.empty()) pictures->features = std::move(features);
  return pictures;
}

}  // namespace

std::optional<Body> named_body(const std::filesystem::path& path) {
  constexpr std::array kPictures = {".jpg", ".jpeg", ".png", ".webp"};
  constexpr std::array kOtherMeanings = {"sphere", "sun", "io", "europa", "titan"};
  if (std::ranges::find(kPictures, lower_extension(path)) == kPictures.end()) return {};
  const std::string name = path.stem().string() + ".";
  std::string word;
  for (const char c : name) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += char(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    const auto body = std::ranges::find(body_presets(), word, &Body::name);
    if (body != body_presets().end() && std::ranges::find(kOtherMeanings, word) == kOtherMeanings.end()) return *body;
    word.clear();
  }
  return {};
}

std::string shown_name(const std::filesystem::path& path) {
  const Url tile_set(path.string());
  const std::string shown = tile_set.without_query();
  if (shown.find("://") != shown.npos) return one_line(shown);
  const std::filesystem::path name = (path.has_filename() ? path : path.parent_path()).filename();
  return one_line(name.empty() ? shown : name.string());
}

std::string shown_name(const SourceOptions& said) {
  return said.remote.name ? one_line(*said.remote.name) : shown_name(path_of(said));
}

Result<OpenedFile> open_dropped(const SourceOptions& said, const SourceOptions& how, const Geodetic& place,
                                const CutProgress& progress) {
  const std::filesystem::path path = path_of(said);
  const std::string extension = lower_extension(path);
  const bool is_file = path.string().find("://") == std::string::npos;
  const bool of_objects = extension == ".geojson" || (is_vector_file(path) && !is_of_either(path)) ||
                          extension == ".glb" || extension == ".gltf";
  if (of_objects && !is_file) {
    return Error{Url(path.string()).redacted() +
                 ": objects and models are read from files only; download this one, and open the file"};
  }
  if (extension == ".glb" || extension == ".gltf") return open_objects(said, place);
  if (is_geojson(path) || (of_objects && is_vector_file(path))) return open_vector(said, how, progress);
  auto tiles = open_tiles(said, how, progress);
  if (!tiles && is_file && is_of_either(path)) {
    auto features = open_objects(said);
    if (features) return features;
  }
  return tiles;
}

DroppedFiles::~DroppedFiles() {
  leave_off();
  if (running_.valid()) running_.wait();
}

void DroppedFiles::add(SourceOptions said, const Geodetic& place) {
  waiting_.push_back({std::move(said), place});
  if (!busy()) start_next();
}

void DroppedFiles::start_next() {
  if (waiting_.empty()) return;
  const Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  current_ = next.said;
  percent_ = -1;
  leave_off_ = false;
  running_ = std::async(std::launch::async, [this, next]() -> Result<OpenedFile> {
    auto opened = open_dropped(next.said, options_, next.place, [this](std::int64_t done, std::int64_t total) {
      const int percent = total > 0 ? int(100 * done / total) : 0;
      if (percent_.exchange(percent) != percent) glfwPostEmptyEvent();
      return !leave_off_;
    });
    glfwPostEmptyEvent();
    return opened;
  });
}

bool DroppedFiles::ready() const {
  return running_.valid() && running_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

std::optional<Result<OpenedFile>> DroppedFiles::poll() {
  if (!ready()) return {};
  Result<OpenedFile> opened = running_.get();
  start_next();
  return opened;
}

std::string DroppedFiles::text() const {
  if (!busy()) return {};
  const std::string name = shown_name(current_);
  const int percent = percent_;
  return percent < 0 ? fmt::format("Opening {}", name) : fmt::format("Cutting {}: {} %; Esc cancels", name, percent);
}

std::vector<SourceOptions> DroppedFiles::leave_off() {
  leave_off_ = true;
  std::vector<SourceOptions> left;
  if (busy()) left.push_back(current_);
  for (Waiting& one : waiting_) left.push_back(std::move(one.said));
  waiting_.clear();
  return left;
}

}  // namespace terrella
