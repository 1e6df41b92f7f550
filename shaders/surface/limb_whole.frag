// Antialiases the limb of a globe with light and without air, whose pixels have their own ground (PatchPass::set_limb()): the
// ground covers a part of the pixel, before what lies beyond the limb.
const float kClear_px = 1.0;                   // the raised ground ends here

void main() {
  if (rows_apart == 0) {
    color_srgb = texelFetch(frame_srgb, ivec2(gl_FragCoord.xy), 0);
    return;
  }
  ivec2 step;
  int outwards = int(ceil(max(0.0, kClear_px - outside_px) / step_px(step)));
  vec2 sides = abs(outward);
  float covered = covered_part(outside_px, max(sides.x, sides.y), max(min(sides.x, sides.y), 0.02));
  color_srgb = vec4(mix(color_at(outwards * step), color_at(ivec2(0)), covered), 1.0);
}
