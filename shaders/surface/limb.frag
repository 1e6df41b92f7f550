// Antialiases the limb. A pixel on the limb mixes the colours just inside and just outside the limb, by the area of the
// pixel on each side.
// The pixels this far away are on one side of the limb.
#if defined(FROM_SAMPLES)
const float kAside_px = 1.5;
#else
const float kAside_px = 1.25;
#endif

vec4 at(float distance_px) {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 p = ivec2(gl_FragCoord.xy + outward * (distance_px - outside_px));
  p.y = here.y + (p.y - here.y) / rows_apart * rows_apart;
  return texelFetch(frame_srgb, clamp(p, part_px.xy, part_px.zw), 0);
}

void main() {
  if (rows_apart == 0) {
    color_srgb = texelFetch(frame_srgb, ivec2(gl_FragCoord.xy), 0);
    return;
  }
  color_srgb = mix(at(-kAside_px), at(kAside_px), clamp(0.5 + outside_px, 0.0, 1.0));
}
