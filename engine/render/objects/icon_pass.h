#pragma once

#include <memory>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/gl_handle.h"
#include "render/objects/layer_buffers.h"
#include "render/objects/object_common.h"
#include "view/render_modes.h"

namespace terrella {

/// Draws icons: pictures of constant size on the screen, turned, tinted and filtered, with smooth edges. An icon's
/// opaque pixels write depth, so the nearest icon is on top; its other pixels are blended over them. thread: main
class IconPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<IconPass>> create(DepthMode depth);

  /// Returns the draw calls made: at most one with opaque objects, and two with translucent ones; twice as many if
  /// the layer has icons that are chosen.
  [[nodiscard]] int draw(const DrawnLayer& layer, const ObjectDraw& draw, Viewport viewport,
                         double hiding_radius_m) const;

 private:
  IconPass() = default;

  gl::Program program_;
  gl::VertexArray array_;
};

}  // namespace terrella
