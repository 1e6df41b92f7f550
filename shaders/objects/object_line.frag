in float across_w;
flat in float half_width_px;
flat in vec4 line_color;
in vec3 air_through;
in vec3 air_light;
flat in float pull;
in float along;          // metres from the line's start
flat in vec2 dash_px;    // lengths of dashes and gaps
layout(location = 0) out vec4 color_srgb;

// The part of the pixel that a dash covers. Lengths in metres are powers of two of those in pixels, so dashes keep their
// places until they have twice or half their size.
float on_dash() {
  float px_m = max(length(vec2(dFdx(along), dFdy(along))), 1e-9), scale_m = exp2(round(log2(relief.w * px_m)));
  float on_m = dash_px.x * scale_m, period_m = (dash_px.x + dash_px.y) * scale_m;
  float from_middle_m = abs(mod(along - 0.5 * on_m + 0.5 * period_m, max(period_m, 1e-9)) - 0.5 * period_m);
  return dash_px.y > 0.0 ? clamp(0.5 + (0.5 * on_m - from_middle_m) / px_m, 0.0, 1.0) : 1.0;
}

void main() {
  float across_px = across_w * gl_FragCoord.w;
  float coverage = clamp(0.5 + half_width_px - abs(across_px), 0.0, 1.0) * min(1.0, 2.0 * half_width_px) * on_dash();
  if (coverage <= 0.0) discard;
  vec3 seen_srgb = in_air() ? seen_through(line_color.rgb, air_through, air_light) : line_color.rgb;
  color_srgb = vec4(seen_srgb, line_color.a * coverage);
  WRITE_DEPTH(pull);
}
