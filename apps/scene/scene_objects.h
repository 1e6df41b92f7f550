#pragma once

#include "apps/scene/scene_options.h"
#include "globe/globe.h"

namespace terrella {

/// Adds the included stars to the globe's options if the options enable the sky, and the city lights if a night may be
/// drawn. Missing or damaged files are reported on standard error and skipped. thread: main
void add_sky_data(GlobeOptions& options, bool night_lights);

/// Adds the included label font to the globe's options. thread: main
void add_label_font(GlobeOptions& options);

/// Adds the objects of --objects to the globe. Faulty objects are reported on standard error and skipped. Returns true
/// if all objects were valid; fails if none can be read. thread: main
[[nodiscard]] Result<bool> add_objects(Globe& globe, const SceneOptions& options);

}  // namespace terrella
