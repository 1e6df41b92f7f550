#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "geo/camera.h"
#include "view/render_modes.h"

namespace terrella {

/// The matrices and the depth format with which a frame of a globe is drawn, for drawing of the application's own.
struct FrameMatrices {
  View view;                       ///< view of the eye whose picture is drawn; `view.eye` in double
  glm::dmat4 view_from_ecef{1.0};  ///< metres; axes of the view: right, up, back
  /// OpenGL clip space with depths from 0 to 1 (glClipControl with GL_ZERO_TO_ONE), without a far plane if depth is
  /// reversed. Logarithmic depth is written per fragment, so here it equals standard depth.
  glm::dmat4 clip_from_view{1.0};
  double near_m = 0.0;
  double far_m = 0.0;  ///< infinite if depth is reversed
  DepthMode depth = DepthMode::reversed;
  glm::ivec2 corner_px{0};  ///< lower left corner of the picture in the framebuffer that is bound
};

/// Moments of a frame at which an application may draw.
enum class DrawStage {
  /// Before the surface: things that a translucent surface shows through. Not called if the surface is opaque.
  below_ground,
  ground,  ///< after the surface, before sky, limb and objects: water, buildings
  all,     ///< after everything
};

/// Returns the matrices of a view. `far_m` is not used if depth is reversed. thread: any
[[nodiscard]] FrameMatrices frame_matrices(const View& view, double near_m, double far_m, DepthMode depth);

}  // namespace terrella
