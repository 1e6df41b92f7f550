#include "apps/viewer/parts/part.h"

#include <algorithm>

#include "apps/open_scene/bounds_view.h"
#include "apps/viewer/input.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {

void fly_over(const ViewerContext& context, const GeoRect& bounds) {
  const Viewport window = context.window.framebuffer();
  const double aspect = double(window.width_px) / std::max(1, window.height_px);
  Navigator& navigator = context.navigator;
  navigator.fly_to(camera_over(bounds, context.globe.options().body.ellipsoid, navigator.camera().fov_y, aspect),
                   Input::now());
}

void Panel::draw(float foot) {
  if (!open_ || covered_) return;
  draw_open(foot);
  if (take_panel_closed()) close();
}

}  // namespace terrella
