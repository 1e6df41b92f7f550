#pragma once

#include "apps/setup/scene_options.h"
#include "globe/globe.h"

namespace terrella {

/// Gives the globe's options the stars and lights that the program carries, if they ask for a sky; what is missing or
/// damaged is said on standard error, and left out. thread: main
void add_sky_data(GlobeOptions& options);

/// Gives the globe's options the font that the program carries, for labels. thread: main
void add_label_font(GlobeOptions& options);

/// Gives the globe the objects that --objects names; what is wrong in the file is said on standard error, and the rest
/// drawn. Returns whether all was right; fails if nothing of it can be read. thread: main
[[nodiscard]] Result<bool> add_objects(Globe& globe, const SceneOptions& options);

}  // namespace terrella
