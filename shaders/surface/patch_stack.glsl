// A layer of a stack: finish() for each of several layers that one pass combines.
layout(location = 0) uniform vec4 stack_texels[STACK];   // as texels of the frame's block
layout(location = 4) uniform vec4 stack_look[STACK];     // opacity; 1 shows by day, -1 by night, 0 by both; 1: brightness is alpha
layout(location = 8) uniform vec4 stack_numbers[STACK];  // as number_look

// Over the layers below. Each layer has the light and the air that it would have alone.
vec4 over(vec4 below, vec4 imagery_srgb, vec4 look, bool special) {
  float alpha = imagery_srgb.a, share = look.x;
  if (special) {
    if (look.z > 0.0) alpha = brightness(imagery_srgb.rgb);
    share *= part_shown(look.y);
  }
  vec3 color = special && look.y < 0.0 ? imagery_srgb.rgb : lit(imagery_srgb.rgb, alpha, false);
  vec4 layer = clamp(vec4(through_air(color, alpha), alpha) * share, 0.0, 1.0);
  return layer + (1.0 - layer.a) * below;
}

vec4 ground(vec3 imagery_srgb) { return vec4(clamp(through_air(lit(imagery_srgb, 1.0, true), 1.0), 0.0, 1.0), 1.0); }
