in vec4 fill_color;
flat in float pull;
layout(location = 0) out vec4 color_srgb;

void main() {
  color_srgb = fill_color;
  WRITE_DEPTH(pull);
}
