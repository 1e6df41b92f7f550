#pragma once

namespace terrella {

/// Sets sizes and colours of all panels, in the current context of Dear ImGui. `scale`: units of the window per pixel
/// at 96 dots per inch. Each text has a contrast of 4.5 : 1 or more with what lies under it (WCAG 2.2, level AA), also
/// over white ground. Not within a frame. thread: main
void set_theme(float scale);

}  // namespace terrella
