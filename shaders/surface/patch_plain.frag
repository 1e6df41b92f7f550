// Plain patches: interpolated coordinates, three taps per pixel on a rank-1 lattice. Exact for footprints up to 3
// texels, accurate enough up to 12 (kPlainFootprint_texels in patch_pass.cpp).
void main() {
  vec2 p = window_point;
  Cell cell = cell_at(p);
  vec2 a = dFdx(p) * (1.0 / 3.0), b = dFdy(p) * (1.0 / 3.0);
  finish((tap(cell, p - a) + tap(cell, p + b) + tap(cell, p + a - b)) * (1.0 / 3.0));
}
