// The surface in one colour, to blend over the picture under it.
layout(location = 0) out vec4 color_srgb;

void main() {
  color_srgb = vec4(0.0, 0.0, 0.0, 1.0);
  WRITE_DEPTH(1.0);
}
