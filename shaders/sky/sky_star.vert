// A star as a point at infinity. Its position depends only on its direction, without near and far plane.
layout(location = 0) in vec3 direction_j2000;
layout(location = 1) in float magnitude;
layout(location = 2) in vec3 star_color_linear;
layout(location = 0) uniform mat3 view_from_j2000;
layout(location = 1) uniform float visibility;
out vec3 peak_linear;
flat out float inverse_variance;
flat out float point_px;

// Light of a star of magnitude 0, in fully lit pixels, and the blur of a point by an eye or a lens, in pixels.
const float kZeroMagnitude_px = 12.0;
const float kSpread_px = 0.6;

void main() {
  vec3 p = view_from_j2000 * direction_j2000;
  gl_Position = vec4(p.xy * clip_scale.xy, -0.5 * p.z, -p.z);
  // A spot cannot be brighter than the screen. Bright stars are wider instead, with the same total light.
  float px = relief.w * relief.w;
  float light_px = px * visibility * kZeroMagnitude_px * exp2(-1.328771 * magnitude);
  float variance = max(px * kSpread_px * kSpread_px, light_px / 6.2831853);
  peak_linear = star_color_linear * (light_px / (6.2831853 * variance));
  inverse_variance = 1.0 / variance;
  point_px = 2.0 * ceil(3.0 * sqrt(variance)) + 1.0;
  gl_PointSize = point_px;
}
