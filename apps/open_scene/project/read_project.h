#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/open_scene/options/scene_options.h"
#include "apps/open_scene/project/project_paths.h"
#include "base/result.h"

namespace terrella {

/// Reads the project that is TILESET of a parsed command line (apps/open_scene/project/README.md) into the options of
/// the command. Options of the command line win over those of the project. Paths of the project are seen from its
/// folder. The error names the file, the entry and its fault; then `options` are as before. thread: main
[[nodiscard]] Status read_project(const CLI::App& command, SceneOptions& options);

/// The same for a project file without a command line. thread: main
[[nodiscard]] Status read_project(const std::filesystem::path& file, SceneOptions& options);

/// Reads an image layer of a project. Paths are seen from `folder`. The error begins with `where` and names the field.
/// thread: main
[[nodiscard]] Result<LayerOption> read_image_layer(const nlohmann::json& layer, const std::filesystem::path& folder,
                                                   const std::string& where);

}  // namespace terrella
