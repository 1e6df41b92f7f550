#pragma once

#include "apps/open_scene/options/scene_options.h"
#include "globe/globe.h"

namespace terrella {

/// Adds the layers above TILESET to the globe: --night, then --clouds on top. The error names the input. Throws
/// BrokenInstallation. thread: main
[[nodiscard]] Status add_image_layers(Globe& globe, const SceneOptions& options);

}  // namespace terrella
