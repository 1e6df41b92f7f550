#pragma once

#include "apps/viewer/styles/layer_style.h"

namespace terrella {

/// Draws the settings of a layer's style inside an open panel: field, kind and number of classes, colour map, and
/// buttons. Stores the user's wishes in `style`. thread: main
void draw_style(LayerStyle& style);

}  // namespace terrella
