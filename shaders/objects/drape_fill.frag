flat in mat3 ecef_from_view;
flat in vec4 plane_ab;
flat in vec4 plane_bc;
flat in vec4 plane_ca;
flat in vec3 inside;
flat in vec4 fill_color;

// Ground on a side belongs to one of the two triangles that share the side.
bool is_inside(vec4 plane, float side, vec3 ground) {
  precise float over = dot(plane.xyz, ground) - plane.w;
  return (over >= 0.0) == (side > 0.0);
}

void main() {
  vec3 ground;
  if (!ground_at(ecef_from_view, ivec2(0), ground)) discard;
  if (!is_inside(plane_ab, inside.x, ground) || !is_inside(plane_bc, inside.y, ground) ||
      !is_inside(plane_ca, inside.z, ground)) {
    discard;
  }
  float day = smoothstep(-0.35, 0.5, dot(normalize(eye_high_ecef.xyz + ground), sun_ecef.xyz));
  color_srgb = vec4(fill_color.rgb * mix(1.0, mix(0.4, 1.0, day), sun_ecef.w), fill_color.a);
  if (!in_air()) return;
  vec3 through, light;
  air_before(ground, through, light);
  color_srgb.rgb = seen_through(color_srgb.rgb, through, light);
}
