in vec2 disc;
in vec3 way_ecef;

// A large sphere may reach out of the air, so each pixel has its own.
void main() {
  float t = draw_sphere(disc, 1.0 / gl_FragCoord.w);
  if (!in_air()) return;
  vec3 through, light;
  air_before(t * way_ecef, through, light);
  color_srgb.rgb = seen_through(color_srgb.rgb, through, light);
}
