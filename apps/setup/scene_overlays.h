#pragma once

#include "apps/setup/scene_options.h"
#include "base/result.h"
#include "globe/globe.h"

namespace terrella {

/// Reads "TILESET" or "TILESET:OPACITY", the opacity in [0, 1]; what follows the last colon and is no number belongs to
/// TILESET. The error names the text. thread: any
[[nodiscard]] Result<OverlayOption> parse_overlay(const std::string& text);

/// Lays what --overlay names over the imagery, in the order given, each with a cache of its own. The error names the
/// overlay. Throws BrokenInstallation. thread: main
[[nodiscard]] Status add_overlays(Globe& globe, const SceneOptions& options);

}  // namespace terrella
