#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/open_scene/options/scene_options.h"

namespace terrella {

/// A project as text, and what it leaves out.
struct ProjectText {
  std::string text;                   ///< JSON, see apps/open_scene/project/README.md
  std::vector<std::string> left_out;  ///< a message for each layer whose address holds a secret
};

/// Writes a scene as a project. Paths are seen from `folder`, or are absolute if `folder` is empty. The layers are
/// those of a project: `base`, `layers`, `object_layers` and `elevation`; layers of the command line do not count.
/// thread: any
[[nodiscard]] ProjectText project_text(const SceneOptions& scene, const std::filesystem::path& folder);

/// Writes a task file of `terrella preload` that names a source on a server with all that is said about it, secrets
/// too. thread: any
[[nodiscard]] std::string preload_task_text(const SourceOptions& source);

}  // namespace terrella
