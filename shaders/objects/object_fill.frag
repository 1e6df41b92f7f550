in vec4 fill_color;
in vec3 air_through;
in vec3 air_light;
flat in float pull;
layout(location = 0) out vec4 color_srgb;

void main() {
  color_srgb = fill_color;
  if (in_air()) color_srgb.rgb = seen_through(fill_color.rgb, air_through, air_light);
  WRITE_DEPTH(pull);
}
