in vec2 offset_px;
flat in float radius_px;
flat in vec4 marker_color;
flat in float pull;
layout(location = 0) out vec4 color_srgb;

const float kOutline_px = 1.5;

void main() {
  float distance_px = length(offset_px);
  float coverage = clamp(0.5 + radius_px - distance_px, 0.0, 1.0);
  if (coverage <= 0.0) discard;
  float outline = min(relief.w * kOutline_px, 0.4 * radius_px);
  float inside = clamp(0.5 + radius_px - outline - distance_px, 0.0, 1.0);
  color_srgb = vec4(marker_color.rgb * mix(0.3, 1.0, inside), marker_color.a * coverage);
  WRITE_DEPTH(pull);
}
