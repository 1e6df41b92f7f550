#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace terrella {

/// The uniform block of shaders/frame.glsl, std140. A plain value. thread: any
struct FrameBlock {
  glm::mat4 view_from_ecef;
  glm::vec4 eye_high_ecef;
  glm::vec4 eye_low_ecef;
  glm::vec4 clip_scale;
  glm::vec4 sun_ecef;
  glm::vec4 texels;
  glm::vec4 paper;
  glm::vec4 layer_look;
  glm::vec4 layer_tone;
  glm::mat4 horizon_from_ecef;
  glm::vec4 relief;
  glm::vec4 surface_look;
  glm::vec4 axis_px;
  glm::vec4 limb;
  glm::vec4 limb_at_px;
  glm::vec4 limb_bend;
};
static_assert(sizeof(FrameBlock) == 64 + 14 * 16 + 64);

}  // namespace terrella
