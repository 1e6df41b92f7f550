// A pixel beside the limb of a finished picture. Shared by all programs of the limb.
layout(binding = 0) uniform sampler2D frame_srgb;
// 2: the rows between belong to the other eye; 0: frame_srgb contains the limb.
layout(location = 0) uniform int rows_apart;
layout(location = 1) uniform ivec4 part_px;    // first and last column and row of this eye's picture
in vec2 outward;
in float outside_px;
layout(location = 0) out vec4 color_srgb;

// The pixel that many steps outwards along a row or a column; `apart` is the distance of a step from the limb.
float step_px(out ivec2 step) {
  bool along_row = abs(outward.x) >= abs(outward.y) || rows_apart > 1;
  if (along_row && outward.x == 0.0) along_row = false;
  step = along_row ? ivec2(int(sign(outward.x)), 0) : ivec2(0, rows_apart * int(sign(outward.y)));
  return dot(vec2(step), outward);
}

vec3 color_at(ivec2 off) {
  return texelFetch(frame_srgb, clamp(ivec2(gl_FragCoord.xy) + off, part_px.xy, part_px.zw), 0).rgb;
}

// Integral of clamp(x, 0, 1).
float ramp_sum(float x) {
  float within = clamp(x, 0.0, 1.0);
  return 0.5 * within * within + max(x - 1.0, 0.0);
}

// Part of a pixel's square inside the limb: the mean of the parts of its strips along the limb, `width` wide, whose
// middles lie evenly in the range around the pixel's.
float covered_part(float distance_px, float width, float range) {
  float middle = 0.5 - distance_px / width, half_range = 0.5 * range / width;
  return (ramp_sum(middle + half_range) - ramp_sum(middle - half_range)) / (2.0 * half_range);
}
