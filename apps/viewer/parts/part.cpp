#include "apps/viewer/parts/part.h"

#include "apps/viewer/panels/panel_items.h"

namespace terrella {

void Panel::draw(float foot) {
  if (!open_ || covered_) return;
  draw_open(foot);
  if (take_panel_closed()) close();
}

}  // namespace terrella
