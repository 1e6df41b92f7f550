// The window point of each pixel by both texturing methods of patches, for comparison with double. The first cell holds
// the patch's number, counted from 1.
layout(location = 1) out uint patch_number;

void main() {
  color_srgb = vec4(window_point, exact_window_point().p);
  patch_number = window.x;
}
