// The Moon: a grey sphere of dust, lit by the Sun (regolith.glsl).
layout(location = 3) uniform vec2 disc_part;      // as in sky_sun.frag
layout(location = 4) uniform vec3 moon_axes_ecef[3];  // right, up, towards the eye
layout(location = 7) uniform vec3 sun_from_moon_ecef; // unit
in vec2 on_disc;
in vec3 direction_ecef;
layout(location = 0) out vec4 color_srgb;

void main() {
  vec2 p = on_disc / disc_part.x;
  float r2 = dot(p, p);
  float inside = clamp((disc_part.x - length(on_disc)) / disc_part.y + 0.5, 0.0, 1.0);
  if (inside == 0.0) discard;
  vec3 n = moon_axes_ecef[0] * p.x + moon_axes_ecef[1] * p.y + moon_axes_ecef[2] * sqrt(max(0.0, 1.0 - r2));
  float day = regolith_light(normalize(n), sun_from_moon_ecef, moon_axes_ecef[2]);
  const vec3 earthshine = vec3(0.0015, 0.0018, 0.0022);
  color_srgb = vec4(encoded_srgb(0.75 * day * vec3(1.0, 0.97, 0.92) + earthshine) * inside, inside);
}
