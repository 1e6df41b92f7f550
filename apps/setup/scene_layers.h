#pragma once

#include "apps/setup/scene_options.h"
#include "globe/globe.h"

namespace terrella {

/// Gives the globe the imagery that lies over TILESET: --night, and --clouds over that. The error names the input.
/// Throws BrokenInstallation. thread: main
[[nodiscard]] Status add_image_layers(Globe& globe, const SceneOptions& options);

}  // namespace terrella
