#include "apps/open_scene/scene_objects.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "apps/open_scene/sky_data.h"
#include "apps/process/console.h"
#include "apps/process/data_dir.h"
#include "streaming/file_bytes.h"
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

Result<SceneObjects> add_objects(Globe& globe, const SceneOptions& options) {
  SceneObjects objects;
  if (options.objects.empty()) return objects;
  if (!options.object_style.empty()) {
    Result<FeatureStyle> loaded = FeatureStyle::load(options.object_style);
    if (!loaded) return loaded.error();
    objects.style = *std::move(loaded);
  }
  const Result<ObjectFile> file = read_objects(options.objects, ObjectId{1}, objects.style);
  if (!file) return file.error();
  for (const std::string& complaint : file->complaints) print_message("{}\n", complaint);
  if (file->complaints_left_out > 0) print_message("and {} more\n", file->complaints_left_out);
  const auto added = globe.add_objects(file->scene);
  if (!added) return added.error();
  if (const Status credited = globe.set_attribution(*added, file->attribution); !credited) return credited.error();
  objects.all = file->complaints.empty();
  if (options.keep_features) objects.features = layer_features(file->scene, objects.style);
  return objects;
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
