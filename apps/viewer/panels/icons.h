#pragma once

#include "apps/viewer/action.h"
#include "geo/angle.h"

struct ImVec2;

namespace terrella {

/// Draws an icon around a centre into the current panel. `half`: half the side of its button, in units of the window.
/// The compass shows where north is for a view with this heading. thread: main
void draw_icon(Icon icon, ImVec2 centre, float half, Angle heading);

}  // namespace terrella
