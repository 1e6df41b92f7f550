#pragma once

#include <vector>

#include "geo/object_edits.h"
#include "geo/objects.h"
#include "streaming/objects/feature_style.h"

namespace terrella {

/// Features of a layer, for drawing them in another style and then in their own.
struct LayerFeatures {
  std::vector<FeatureParts> parts = {};
  /// Edits that give all features their own colours and sizes back. A feature of several kinds of objects, each with a
  /// colour of its own, is removed and added again.
  ObjectEdits own = {};
  FeatureStyle style = {};  ///< the style that the features were read in
};

/// Returns the features of a scene that was read in a style. thread: any
[[nodiscard]] LayerFeatures layer_features(const ObjectScene& scene, FeatureStyle style = {});

}  // namespace terrella
