#include "apps/viewer/parts/globe_frame.h"

#include <epoxy/gl.h>

namespace terrella {

void GlobeFrame::draw(Globe& globe, Viewport framebuffer) {
  const bool resized = !target_ || size_ != framebuffer;
  if (resized) target_.emplace(size_ = framebuffer);
  if (resized || globe.needs_frame()) stats_ = globe.render(target_->framebuffer(), framebuffer);
  glBlitNamedFramebuffer(target_->framebuffer(), 0, 0, 0, framebuffer.width_px, framebuffer.height_px, 0, 0,
                         framebuffer.width_px, framebuffer.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace terrella
