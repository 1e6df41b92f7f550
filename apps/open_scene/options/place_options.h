#pragma once

#include <CLI/App.hpp>

#include "base/result.h"
#include "streaming/georeference/georeference.h"

namespace terrella {

/// Adds --crs, --bounds and --west for the place of a picture; `words` must outlive the parse, which checks
/// them. thread: main
void add_place_options(CLI::App& command, PlaceWords& words);

}  // namespace terrella
