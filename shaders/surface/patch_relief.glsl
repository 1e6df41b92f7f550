// Light on relief, by the slopes of the heights around a fragment.
#if defined(RELIEF)
layout(binding = 9) uniform sampler2DArray slopes;           // rise per metre towards east and north; bilinear
layout(binding = 10) uniform usamplerBuffer slope_cells;      // as window_cells

in vec2 slope_point;
in vec3 light_enu;
flat in uvec4 slope_window;      // as window

// A slope towards the light is brighter than level ground by this share of the change in the light's sine, but by no
// more than kMostGain: the sky lights slopes that the Sun does not.
const float kContrast = 1.3;
const float kMostGain = 0.6;

vec2 ground_slope() {
  ivec2 size = ivec2(slope_window.y & 0xFFFFu, slope_window.y >> 16);
  ivec2 c = clamp(ivec2(slope_point), ivec2(0), size - 1);
  uint bits = texelFetch(slope_cells, int(slope_window.x) + c.y * size.x + c.x).x;
  uint up = bits >> 24;
  float scale = relief.z * uintBitsToFloat((127u - up) << 23);
  vec2 part = vec2((slope_window.zw + uvec2(c)) & ((1u << up) - 1u)) - vec2(c);
  vec2 inside = clamp(slope_point, vec2(0.0), vec2(size));
  vec3 at = vec3((inside + part) * scale + (0.5 - 0.5 * relief.z), float(bits & 0xFFFFu));
  return relief.x * textureLod(slopes, at, 0.0).xy;
}

// Factor for the light of level ground. After sunset the sky lights all slopes nearly alike.
float relief_light() {
  vec2 slope = ground_slope();
  float sine = (light_enu.z - dot(slope, light_enu.xy)) * inversesqrt(1.0 + dot(slope, slope));
  float gain = kContrast * smoothstep(-0.5, 0.0, light_enu.z) * (sine - light_enu.z);
  return 1.0 + gain * inversesqrt(1.0 + gain * gain / (kMostGain * kMostGain));
}
#endif
