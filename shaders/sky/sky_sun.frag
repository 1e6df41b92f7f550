// The Sun's disc, darker towards its rim, with the glow that a lens adds.
// Radius of the disc and size of a pixel, relative to half the square's width.
layout(location = 3) uniform vec2 disc_part;
in vec2 on_disc;
in vec3 direction_ecef;
layout(location = 0) out vec4 color_srgb;

void main() {
  float r = length(on_disc);
  float inside = clamp((disc_part.x - r) / disc_part.y + 0.5, 0.0, 1.0);
  float x = min(r / disc_part.x, 1.0);
  float limb = 0.4 + 0.6 * sqrt(1.0 - x * x);
  float fade = max(0.0, 1.0 - r);
  vec3 disc = inside * limb * vec3(3.0, 2.8, 2.5);
  vec3 glow = (0.25 * fade * fade * fade + 0.02 * fade / (r * 6.0 + 0.05)) * vec3(1.0, 0.86, 0.66);
  color_srgb = vec4(encoded_srgb(disc + glow * fade), 0.0);
}
