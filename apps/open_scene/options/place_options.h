#pragma once

#include <CLI/App.hpp>
#include <string>

#include "base/result.h"
#include "streaming/georeference/georeference.h"

namespace terrella {

/// Adds --crs, --bounds and --west for the place of a picture; `words` must outlive the parse, which checks
/// them. thread: main
void add_place_options(CLI::App& command, PlaceWords& words);
/// Throws a CLI::ValidationError if the words contradict one another or are out of range. thread: main
void check_place(const PlaceWords& words);
/// Reads W,S,E,N. The error quotes the text. thread: any
[[nodiscard]] Result<CrsBounds> parse_bounds(const std::string& text);
/// Writes bounds as --bounds reads them. thread: any
[[nodiscard]] std::string bounds_text(const CrsBounds& bounds);

}  // namespace terrella
