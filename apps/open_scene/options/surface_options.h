#pragma once

#include <CLI/App.hpp>

#include "apps/open_scene/options/scene_options.h"

namespace terrella {

/// Adds the options for heights and their light. thread: main
void add_relief_options(CLI::App& command, SceneOptions& options);
/// Adds the options for a translucent surface and for views from under the ground. thread: main
void add_translucency_options(CLI::App& command, SceneOptions& options);

/// Adds --overlay and --overlay-projection. thread: main
void add_overlay_options(CLI::App& command, SceneOptions& options);
/// Adds the options for the night side and for clouds. thread: main
void add_layer_options(CLI::App& command, SceneOptions& options);

}  // namespace terrella
