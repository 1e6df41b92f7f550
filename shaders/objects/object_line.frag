in float across_w;
flat in float half_width_px;
flat in vec4 line_color;
in vec3 air_through;
in vec3 air_light;
flat in float pull;
layout(location = 0) out vec4 color_srgb;

void main() {
  float across_px = across_w * gl_FragCoord.w;
  float coverage = clamp(0.5 + half_width_px - abs(across_px), 0.0, 1.0) * min(1.0, 2.0 * half_width_px);
  if (coverage <= 0.0) discard;
  vec3 seen_srgb = in_air() ? seen_through(line_color.rgb, air_through, air_light) : line_color.rgb;
  color_srgb = vec4(seen_srgb, line_color.a * coverage);
  WRITE_DEPTH(pull);
}
