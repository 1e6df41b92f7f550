// Plain patches: interpolated coordinates, three taps on a rank-1 lattice over the pixel. Exact to footprints of 3
// texels, good to 8.
void main() {
  vec2 p = window_point;
  Cell cell = cell_at(p);
  vec2 a = dFdx(p) * (1.0 / 3.0), b = dFdy(p) * (1.0 / 3.0);
  finish((tap(cell, p - a) + tap(cell, p + b) + tap(cell, p + a - b)) * (1.0 / 3.0));
}
