// Antialiases the limb: a pixel that the limb crosses takes the colours just inside and just outside it, by the part of the
// pixel that each covers.
layout(binding = 0) uniform sampler2D frame_srgb;
in vec2 outward;
in float outside_px;
layout(location = 0) out vec4 color_srgb;

vec4 at(float distance_px) {
  vec2 p = gl_FragCoord.xy + outward * (distance_px - outside_px);
  return texelFetch(frame_srgb, clamp(ivec2(p), ivec2(0), textureSize(frame_srgb, 0) - 1), 0);
}

void main() {
  color_srgb = mix(at(-1.25), at(1.25), clamp(0.5 + outside_px, 0.0, 1.0));
}
