flat in mat2 disc_from_px;
flat in vec3 disc_w;
flat in float size_px;
flat in vec3 air_through;
flat in vec3 air_light;

void main() {
  vec2 disc = disc_from_px * ((gl_PointCoord - 0.5) * vec2(size_px, -size_px));   // rows of a point run down
  draw_sphere(disc, disc_w.z + dot(disc_w.xy, disc));
  if (in_air()) color_srgb.rgb = seen_through(color_srgb.rgb, air_through, air_light);
}
