#include "apps/open_scene/scene_objects.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "apps/open_scene/bounds_view.h"
#include "apps/open_scene/sky_data.h"
#include "apps/process/console.h"
#include "apps/process/data_dir.h"
#include "streaming/file_bytes.h"
#include "streaming/objects/classes/class_style.h"
#include "streaming/objects/gltf_model.h"
#include "streaming/objects/vector_objects.h"

namespace terrella {

void add_sky_data(GlobeOptions& options, bool night_lights) {
  if (!options.sky) return;
  SkyData data = load_sky_data(night_lights);
  for (const std::string& problem : data.problems) print_message("{}\n", problem);
  options.stars = std::move(data.stars);
  options.night_lights = std::move(data.night_lights);
}

void add_label_font(GlobeOptions& options) {
  constexpr std::size_t kMostFontBytes = 32UL << 20;
  try {
    auto font = read_file(data_file("DejaVuSans.ttf"), kMostFontBytes);
    if (font) {
      options.label_font = std::move(*font);
    } else {
      print_message("{}; objects are without labels\n", font.error().message);
    }
  } catch (const BrokenInstallation& broken) {
    print_message("{}\nobjects are without labels\n", broken.what());
  }
}

Result<ObjectFile> read_object_layer(const ObjectsOption& option, const FeatureStyle& style) {
  if (!option.model_place) return read_objects(option.file, ObjectId{1}, style);
  Result<ModelFile> model = read_gltf_model(option.file);
  if (!model) return model.error();
  ObjectFile file{.scene = {}, .complaints = std::move(model->complaints), .complaints_left_out = 0};
  file.scene.meshes.push_back({.model = std::move(model->model), .place = *option.model_place});
  return file;
}

namespace {

/// Draws a layer in the style that the window gave it, over the style of its file.
Status restyle(Globe& globe, SceneObjects& layer, const LayerFeatures& features) {
  if (layer.option.style_over.empty()) return Done{};
  Result<FeatureStyle> style = overlaid(layer.style, layer.option.style_over);
  if (!style) return Error{layer.option.file + ": " + style.error().message};
  layer.style = *std::move(style);
  layer.shown_when = shown_when(features.parts, layer.style);
  return globe.edit_objects(layer.id, restyled(features.parts, layer.style));
}

}  // namespace

Result<SceneObjects> add_objects(Globe& globe, const ObjectsOption& option, bool keep_features) {
  SceneObjects layer{.option = option};
  if (!option.style.empty()) {
    Result<FeatureStyle> loaded = FeatureStyle::load(option.style);
    if (!loaded) return loaded.error();
    layer.style = *std::move(loaded);
  }
  Result<ObjectFile> file = read_object_layer(option, layer.style);
  if (!file) return file.error();
  for (const std::string& complaint : file->complaints) print_message("{}\n", complaint);
  if (file->complaints_left_out > 0) print_message("and {} more\n", file->complaints_left_out);
  layer.faultless = file->complaints.empty();
  layer.has_pictures = file->ground_overlays > 0;
  layer.shown_when = std::move(file->shown_when);
  layer.bounds = bounds_of(file->scene);
  const bool needs_features = keep_features || !option.style_over.empty();
  LayerFeatures features = needs_features ? layer_features(file->scene, layer.style) : LayerFeatures{};
  if (keep_features) layer.list = listed_features(file->scene);
  if (keep_features || option.cluster_px > 0.0) layer.points = cluster_points(file->scene);
  const auto added = globe.add_objects(std::move(file->scene), option.shown);
  if (!added) return added.error();
  layer.id = *added;
  if (const Status done = restyle(globe, layer, features); !done) return done.error();
  if (const Status faded = globe.fade_objects(layer.id, option.opacity); !faded) return faded.error();
  if (const Status told = globe.set_attribution(layer.id, file->attribution); !told) return told.error();
  if (keep_features) layer.features = std::move(features);
  return layer;
}

std::vector<std::string> fill_complaints(const Globe& globe, LayerId layer, const std::string& file) {
  constexpr std::size_t kMostNamed = 16;
  std::vector<std::string> complaints;
  const std::vector<MissingFill> missing = globe.missing_fills(layer);
  for (std::size_t k = 0; k < std::min(missing.size(), kMostNamed); ++k) {
    complaints.push_back(fmt::format("{}: feature {}: it is drawn without its fill: {}", file,
                                     static_cast<std::uint64_t>(missing[k].id), to_text(missing[k].fault)));
  }
  if (missing.size() > kMostNamed) complaints.push_back(fmt::format("and {} more", missing.size() - kMostNamed));
  return complaints;
}

}  // namespace terrella
