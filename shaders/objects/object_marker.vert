// One marker per instance: a disc with a diameter in pixels, at the depth of its place.
layout(location = 0) in vec3 center_high_ecef;
layout(location = 1) in vec3 center_low_ecef;
layout(location = 2) in float size;          // diameter, pixels
layout(location = 3) in vec4 color;

out vec2 offset_px;
flat out float radius_px;
flat out vec4 marker_color;
flat out float pull;

void main() {
  vec3 center = from_eye(center_high_ecef, center_low_ecef);
  vec3 c = mat3(view_from_ecef) * center;
  radius_px = 0.5 * relief.w * size;
  marker_color = color;
  offset_px = corner_of(gl_VertexID) * (radius_px + 1.0);
  // The ground under a disc's lower half is nearer to the eye than its place. This amount suffices down to a slant of
  // 14 degrees.
  pull = 1.0 - (depth_bias > 0.0 ? depth_bias + min(4.0 * radius_px / focal_px(), 0.5) : 0.0);
  vec4 clip = clip_of(c, pull);
  if (clip.w > 0.0) clip.xy += offset_px * (2.0 / viewport_px) * clip.w;
  gl_Position = color.a == 0.0 || is_hidden(center, length(center), 0.0) ? kNowhere : clip;
}
