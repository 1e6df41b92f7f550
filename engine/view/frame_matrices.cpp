#include "view/frame_matrices.h"

#include <limits>

namespace terrella {

FrameMatrices frame_matrices(const View& view, double near_m, double far_m, DepthMode depth) {
  const glm::dmat3 turned = view_from_ecef_rotation(view);
  FrameMatrices matrices{.view = view, .near_m = near_m, .far_m = far_m, .depth = depth};
  matrices.view_from_ecef = glm::dmat4(turned);
  matrices.view_from_ecef[3] = glm::dvec4(turned * -view.eye.xyz_m, 1.0);
  glm::dmat4& clip = matrices.clip_from_view;
  clip[0][0] = 1.0 / (view.tan_half_fov_y * view.aspect());
  clip[1][1] = 1.0 / view.tan_half_fov_y;
  clip[2][3] = -1.0;
  clip[3][3] = 0.0;
  if (depth == DepthMode::reversed) {
    matrices.far_m = std::numeric_limits<double>::infinity();
    clip[2][2] = 0.0;
    clip[3][2] = near_m;
  } else {
    clip[2][2] = -far_m / (far_m - near_m);
    clip[3][2] = -near_m * far_m / (far_m - near_m);
  }
  return matrices;
}

}  // namespace terrella
