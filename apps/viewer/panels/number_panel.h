#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/open_scene/scene_numbers.h"
#include "view/number_look.h"

namespace terrella {

/// Draws the settings of a layer of numbers inside an open panel: colour map, histogram with two handles for the first
/// and the last shown value, fields and buttons for them, and facts. Changes `look` and `facts.colormap`. thread: main
void draw_numbers(NumberFacts& facts, NumberLook& look);

/// The look after one end of the stretch was dragged to a value; the other end keeps a distance. thread: any
[[nodiscard]] NumberLook dragged(NumberLook look, bool high_end, double value);

}  // namespace terrella
