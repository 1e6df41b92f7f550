// A layer of a stack: finish() for each of several layers that one pass combines.
layout(location = 0) uniform vec4 stack_texels[STACK];   // as texels of the frame's block
layout(location = 4) uniform vec4 stack_look[STACK];     // as layer_look of the frame's block
layout(location = 8) uniform vec4 stack_numbers[STACK];  // as number_look
layout(location = 12) uniform float stack_opacity[STACK];
layout(location = 16) uniform vec4 stack_tone[STACK];    // as layer_tone  // 20: points_a_side of patch.vert
layout(location = 24) uniform vec4 stack_lines[STACK];   // as number_lines

// Over the layers below. Each layer has the light and the air that it would have alone.
vec4 over(vec4 below, vec4 imagery_srgb, float opacity, vec4 look, vec4 tone, bool special, bool numbers) {
  float alpha = imagery_srgb.a, share = opacity;
  if (special) {
    imagery_srgb.rgb = toned(imagery_srgb.rgb, alpha, tone);
    if (look.y > 0.0) alpha = brightness(imagery_srgb.rgb);
    share *= part_shown(look.x) * on_side(look.z);
  }
  vec4 seen_srgb;
  if (numbers && look.w > 0.0) {
    seen_srgb = vec4(imagery_srgb.rgb, alpha);
  } else {
    vec3 color = special && look.x < 0.0 ? imagery_srgb.rgb : lit(imagery_srgb.rgb, alpha, false);
    seen_srgb = vec4(through_air(color, alpha), alpha);
  }
  vec4 layer = clamp(seen_srgb * share, 0.0, 1.0);
  return layer + (1.0 - layer.a) * below;
}

vec4 ground(vec3 imagery_srgb, vec4 look, bool numbers) {
  if (numbers && look.w > 0.0) return vec4(imagery_srgb, 1.0);
  return vec4(clamp(through_air(lit(imagery_srgb, 1.0, true), 1.0), 0.0, 1.0), 1.0);
}
