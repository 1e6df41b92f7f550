#include "render/frame_camera.h"

#include <glm/mat3x3.hpp>

#include "geo/split_position.h"

namespace terrella {

FrameBlock frame_of_camera(const View& view, double near_m, double far_m) {
  const SplitPosition eye = split_position(view.eye.xyz_m);
  FrameBlock block{};
  block.view_from_ecef = glm::mat4(glm::mat3(view_from_ecef_rotation(view)));
  block.eye_high_ecef = glm::vec4(eye.high, 0.0F);
  block.eye_low_ecef = glm::vec4(eye.low, 0.0F);
  block.clip_scale = glm::vec4(1.0 / (view.tan_half_fov_y * view.aspect()), 1.0 / view.tan_half_fov_y, near_m, far_m);
  block.relief.w = 1.0F;
  return block;
}

}  // namespace terrella
