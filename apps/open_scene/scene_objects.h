#pragma once

#include <string>
#include <vector>

#include "apps/open_scene/options/scene_options.h"
#include "globe/globe.h"
#include "streaming/objects/classes/layer_features.h"

namespace terrella {

/// Adds the included stars to the globe's options if the options enable the sky, and the city lights if a night may be
/// drawn. Missing or damaged files are reported on standard error and skipped. thread: main
void add_sky_data(GlobeOptions& options, bool night_lights);

/// Adds the included label font to the globe's options. thread: main
void add_label_font(GlobeOptions& options);

/// The layer of --objects.
struct SceneObjects {
  bool all = true;              ///< false if objects were faulty
  FeatureStyle style = {};      ///< the style of --object-style
  LayerFeatures features = {};  ///< empty unless SceneOptions::keep_features
};

/// Adds the objects of --objects to the globe. Faulty objects are reported on standard error and skipped. Fails if none
/// can be read. thread: main
[[nodiscard]] Result<SceneObjects> add_objects(Globe& globe, const SceneOptions& options);

/// Returns a message for each area of an object layer that is drawn without its fill, at most 16 and the number of the
/// others. Objects of `file` have the numbers of its features. thread: main
[[nodiscard]] std::vector<std::string> fill_complaints(const Globe& globe, LayerId layer, const std::string& file);

}  // namespace terrella
