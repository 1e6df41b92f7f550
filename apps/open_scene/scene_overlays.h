#pragma once

#include <optional>
#include <vector>

#include "apps/open_scene/options/scene_options.h"
#include "apps/open_scene/scene_numbers.h"
#include "base/result.h"
#include "globe/globe.h"

namespace terrella {

/// Reads "TILESET" or "TILESET:OPACITY", with an opacity in [0, 1]. Text after the last colon belongs to TILESET unless
/// the text is a number. The error names the text. thread: any
[[nodiscard]] Result<OverlayOption> parse_overlay(const std::string& text);

/// Adds the layers of --overlay in the given order, each with its own cache. Returns the facts of each that has
/// numbers. The error names the overlay. Throws BrokenInstallation. thread: main
[[nodiscard]] Result<std::vector<std::optional<NumberFacts>>> add_overlays(Globe& globe, const SceneOptions& options);

}  // namespace terrella
