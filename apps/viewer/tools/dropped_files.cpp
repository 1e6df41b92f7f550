#include "apps/viewer/tools/dropped_files.h"

#include <GLFW/glfw3.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include "apps/open_scene/scene_objects.h"
#include "apps/process/console.h"
#include "streaming/file_bytes.h"
#include "streaming/objects/vector_objects.h"
#include "streaming/url.h"

namespace terrella {
namespace {

constexpr std::size_t kGeoJsonHead = 4096;

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

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

Result<OpenedFile> open_objects(const std::filesystem::path& path, std::optional<Geodetic> model_place = {}) {
  auto file = read_object_layer({.file = path.string(), .model_place = model_place});
  if (!file) return file.error();
  return OpenedFile{path, *std::move(file), model_place};
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

Result<OpenedFile> open_tiles(const std::filesystem::path& path, const SourceOptions& options,
                              const CutProgress& progress) {
  SourceOptions tiles_options = options_beside(options, path.string());
  std::vector<std::shared_ptr<GrowingCut>> cuts;
  tiles_options.cuts = &cuts;
  OpenedRasters rasters;
  tiles_options.opened = &rasters;
  auto tiles = open_any_tiles(tiles_options, progress);
  if (!tiles) return tiles.error();
  FactsReader read_facts = facts_reader(tiles_options.address, {}, {}, rasters);
  if (!is_of_heights((*tiles)->info())) {
    auto layer = layer_of(*std::move(tiles), {}, path.string(), true);
    if (!layer) return layer.error();
    return OpenedFile{path, *std::move(layer), {}, std::move(cuts), std::move(read_facts)};
  }
  auto heights = ElevationSource::open(*std::move(tiles), path.string());
  if (!heights) return heights.error();
  return OpenedFile{path, *std::move(heights), {}, {}, std::move(read_facts)};
}

/// Opens the features of a vector file; of a KML file with its pictures, if it has some.
Result<OpenedFile> open_vector(const std::filesystem::path& path, const SourceOptions& options,
                               const CutProgress& progress) {
  auto opened = open_objects(path);
  if (!opened) return opened.error();
  auto& features = std::get<ObjectFile>(opened->what);
  if (features.ground_overlays == 0) return opened;
  auto pictures = open_tiles(path, options, progress);
  if (!pictures && features.scene.empty()) return pictures.error();
  if (!pictures) {
    features.complaints.insert(features.complaints.begin(), pictures.error().message);
    return opened;
  }
  if (!features.scene.empty()) pictures->features = std::move(features);
  return pictures;
}

}  // namespace

std::string shown_name(const std::filesystem::path& path) {
  const Url tile_set(path.string());
  const std::string shown = tile_set.without_query();
  if (shown.find("://") != shown.npos) return one_line(shown);
  const std::filesystem::path name = (path.has_filename() ? path : path.parent_path()).filename();
  return one_line(name.empty() ? shown : name.string());
}

Result<OpenedFile> open_dropped(const std::filesystem::path& path, const SourceOptions& options, const Geodetic& place,
                                const CutProgress& progress) {
  const std::string extension = lower_extension(path);
  const bool is_file = path.string().find("://") == std::string::npos;
  const bool of_objects = extension == ".geojson" || (is_vector_file(path) && !is_of_either(path)) ||
                          extension == ".glb" || extension == ".gltf";
  if (of_objects && !is_file) {
    return Error{Url(path.string()).redacted() +
                 ": objects and models are read from files only; download this one, and open the file"};
  }
  if (extension == ".glb" || extension == ".gltf") return open_objects(path, place);
  if (is_geojson(path) || (of_objects && is_vector_file(path))) return open_vector(path, options, progress);
  auto tiles = open_tiles(path, options, progress);
  if (!tiles && is_file && is_of_either(path)) {
    auto features = open_objects(path);
    if (features) return features;
  }
  return tiles;
}

DroppedFiles::~DroppedFiles() {
  leave_off();
  if (running_.valid()) running_.wait();
}

void DroppedFiles::add(std::filesystem::path path, const Geodetic& place) {
  waiting_.push_back({std::move(path), place});
  if (!busy()) start_next();
}

void DroppedFiles::start_next() {
  if (waiting_.empty()) return;
  const Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  current_ = next.path;
  percent_ = -1;
  leave_off_ = false;
  running_ = std::async(std::launch::async, [this, next]() -> Result<OpenedFile> {
    auto opened = open_dropped(next.path, options_, next.place, [this](std::int64_t done, std::int64_t total) {
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

void DroppedFiles::leave_off() {
  leave_off_ = true;
  waiting_.clear();
}

}  // namespace terrella
