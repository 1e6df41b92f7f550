in vec3 normal_ecef;
in vec3 way_ecef;
in vec3 air_through;
in vec3 air_light;
flat in vec4 solid_color;
flat in float pull;
layout(location = 0) out vec4 color_srgb;

void main() {
  vec3 to_eye = -normalize(way_ecef), normal = normalize(normal_ecef);
  if (dot(normal, to_eye) < 0.0) normal = -normal;
  color_srgb = vec4(solid_color.rgb * light_on(normal, to_eye), solid_color.a);
  if (in_air()) color_srgb.rgb = seen_through(color_srgb.rgb, air_through, air_light);
  WRITE_DEPTH(pull);
}
