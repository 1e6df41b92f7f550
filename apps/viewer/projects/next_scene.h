#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/open_scene/options/source_options.h"
#include "geo/body.h"

namespace terrella {

/// The scene that replaces that of the window: a project, or the globe of a body.
struct NextScene {
  std::filesystem::path project = {};      ///< empty: none
  Body body = earth();                     ///< counts without a project
  bool afresh = false;                     ///< the globe as at the first start; else as it was left
  std::vector<SourceOptions> layers = {};  ///< files and addresses to open on the globe
};

}  // namespace terrella
