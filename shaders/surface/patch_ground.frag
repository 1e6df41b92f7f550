// Lines and areas on the ground, drawn over a patch.
layout(location = 0) out vec4 color_srgb;

void main() {
  color_srgb = objects_seen();
  WRITE_DEPTH(1.0);
}
