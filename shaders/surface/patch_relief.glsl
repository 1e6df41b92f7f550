// Light on relief, by the slopes of the heights around a fragment.
#if defined(RELIEF)
layout(binding = 9) uniform sampler2DArray slopes;           // rise per metre towards east and north; bilinear
layout(binding = 10) uniform usamplerBuffer slope_cells;      // as window_cells

in vec2 slope_point;
flat in uvec4 slope_window;      // as window
#if defined(AT_POLE)
flat in vec2 slope_column;       // column of the patch's centre; columns per degree

// Within a triangle at a pole longitude turns by tens of degrees, and east and north with it. There each fragment has
// its own.
vec3 ground_normal();            // patch_common.glsl
float east_of_center_deg();

vec2 slope_place() { return vec2(slope_column.x + slope_column.y * east_of_center_deg(), slope_point.y); }

vec3 light_from() {
  if (relief.y > 0.0) return vec3(-0.5, 0.5, 0.70710678);
  vec3 normal = normalize(ground_normal()), sun = sun_ecef.xyz;
  float outward = dot(normal.xy, sun.xy), sine2 = max(dot(normal.xy, normal.xy), 1e-20);
  vec2 level = vec2(normal.x * sun.y - normal.y * sun.x, sun.z * sine2 - normal.z * outward) * inversesqrt(sine2);
  return vec3(level, outward + normal.z * sun.z);
}
#else
in vec3 light_enu;

vec2 slope_place() { return slope_point; }
vec3 light_from() { return light_enu; }
#endif

// A slope towards the light is brighter than level ground by this share of the change in the light's sine, but by no
// more than kMostGain: the sky lights slopes that the Sun does not.
const float kContrast = 1.3;
const float kMostGain = 0.6;

vec2 ground_slope() {
  ivec2 size = ivec2(slope_window.y & 0xFFFFu, slope_window.y >> 16);
  vec2 place = slope_place();
  ivec2 c = clamp(ivec2(place), ivec2(0), size - 1);
  uint bits = texelFetch(slope_cells, int(slope_window.x) + c.y * size.x + c.x).x;
  uint up = bits >> 24;
  float scale = relief.z * uintBitsToFloat((127u - up) << 23);
  vec2 part = vec2((slope_window.zw + uvec2(c)) & ((1u << up) - 1u)) - vec2(c);
  vec2 inside = clamp(place, vec2(0.0), vec2(size));
  vec3 at = vec3((inside + part) * scale + (0.5 - 0.5 * relief.z), float(bits & 0xFFFFu));
  return relief.x * textureLod(slopes, at, 0.0).xy;
}

// Factor for the light of level ground. After sunset the sky lights all slopes nearly alike.
float relief_light() {
  vec2 slope = ground_slope();
  vec3 light = light_from();
  float sine = (light.z - dot(slope, light.xy)) * inversesqrt(1.0 + dot(slope, slope));
  float gain = kContrast * smoothstep(-0.5, 0.0, light.z) * (sine - light.z);
  return 1.0 + gain * inversesqrt(1.0 + gain * gain / (kMostGain * kMostGain));
}
#endif
