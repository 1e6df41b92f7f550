#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/open_scene/listed_features.h"
#include "apps/open_scene/options/scene_options.h"
#include "globe/features/point_clusters.h"
#include "globe/globe.h"
#include "streaming/objects/classes/layer_features.h"
#include "streaming/objects/geojson_objects.h"

namespace terrella {

/// Adds the included stars to the globe's options if the options enable the sky, and the city lights if a night may be
/// drawn. Missing or damaged files are reported on standard error and skipped. thread: main
void add_sky_data(GlobeOptions& options, bool night_lights);

/// Adds the included label font to the globe's options. thread: main
void add_label_font(GlobeOptions& options);

/// An object layer of an opened scene.
struct SceneObjects {
  LayerId id = LayerId::none;
  ObjectsOption option;
  std::optional<GeoRect> bounds{};      ///< none without objects
  bool faultless = true;                ///< false if objects were faulty
  FeatureStyle style{};                 ///< the style in which they are drawn
  LayerFeatures features{};             ///< empty unless they are kept
  std::vector<ListedFeature> list{};    ///< empty unless features are kept
  std::vector<ShownWhen> shown_when{};  ///< features that are not always shown
  bool has_pictures = false;            ///< the file is a KML file whose pictures are imagery
  std::vector<ClusterPoint> points{};   ///< may be in clusters; empty unless features are kept, or clusters asked for
};

/// Reads a file of objects in its style, or a model and puts it in its place. The error names the file. thread: any
[[nodiscard]] Result<ObjectFile> read_object_layer(const ObjectsOption& option, const FeatureStyle& style = {});

/// Adds an object layer to the globe. Faulty objects are reported on standard error and skipped. Fails if none can be
/// read. `keep_features`, for other styles. thread: main
[[nodiscard]] Result<SceneObjects> add_objects(Globe& globe, const ObjectsOption& option, bool keep_features);

/// Returns a message for each area of an object layer that is drawn without its fill, at most 16 and the number of the
/// others. Objects of `file` have the numbers of its features. thread: main
[[nodiscard]] std::vector<std::string> fill_complaints(const Globe& globe, LayerId layer, const std::string& file);

}  // namespace terrella
