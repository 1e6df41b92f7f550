// Plain patches: interpolated coordinates, three taps on a rank-1 lattice over the pixel. kPlainFootprint_texels
// (engine/surface/patch_selection.h) says up to which length of a pixel, and with what error.
void main() {
  vec2 p = window_point;
  Cell cell = cell_at(p);
  vec2 a = dFdx(p) * (1.0 / 3.0), b = dFdy(p) * (1.0 / 3.0);
  finish(seen((precise_tap(cell, p - a) + precise_tap(cell, p + b) + precise_tap(cell, p + a - b)) * (1.0 / 3.0)));
}
