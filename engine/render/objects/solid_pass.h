#pragma once

#include <memory>

#include "base/result.h"
#include "render/gl/gl_handle.h"
#include "render/objects/layer_buffers.h"
#include "render/objects/object_common.h"
#include "view/render_modes.h"

namespace terrella {

/// Draws extruded areas. thread: main
class SolidPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<SolidPass>> create(DepthMode depth);

  /// True if the layer has extruded areas.
  [[nodiscard]] static bool is_needed(const DrawnLayer& layer);
  /// Returns the draw calls made: at most one for opaque areas, chosen or not, and two for translucent ones: sides away
  /// from the eye, then towards it.
  [[nodiscard]] int draw(const DrawnLayer& layer, const ObjectDraw& draw) const;

 private:
  SolidPass() = default;

  gl::Program program_;
  gl::VertexArray array_;
};

}  // namespace terrella
