// The window point of each pixel by both ways that patches are textured, to be compared with double. The patch's number,
// from 1, stands in place of its first cell.
layout(location = 1) out uint patch_number;

void main() {
  color_srgb = vec4(window_point, exact_window_point().p);
  patch_number = window.x;
}
