#pragma once

#include <CLI/CLI.hpp>

#include "apps/open_scene/options/option_checks.h"
#include "apps/viewer/panels/readout.h"

namespace terrella {

/// The option --units, which stores LengthUnits, or an optional of them, in `units`. thread: any
template <class Target>
CLI::Option* add_units_option(CLI::App& command, Target& units) {
  return add_choice<LengthUnits>(
      command, "--units", units,
      {{"metric", LengthUnits::metric}, {"imperial", LengthUnits::imperial}, {"nautical", LengthUnits::nautical}},
      "Choose the units of the scale bar, of heights and of measured lengths");
}

}  // namespace terrella
