// The air before a translucent surface, as light alone. Air lies before the surface, whatever that one's opacity.
layout(location = 0) out vec4 color_srgb;

void main() {
  color_srgb = vec4(through_air(vec3(0.0), 1.0), 1.0);
  WRITE_DEPTH(1.0);
}
