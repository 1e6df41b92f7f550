// Plain patches: interpolated coordinates, four taps on a rotated grid over the pixel. Exact
// to footprints of 4 texels, good to 8.
void main() {
  vec2 p = window_point;
  vec4 cell = cell_at(p);
  vec2 a = dFdx(p) * 0.125, b = dFdy(p) * 0.125;
  vec2 d = a + 3.0 * b, e = 3.0 * a - b;
  finish(0.25 * ((tap(cell, p + d) + tap(cell, p - d)) + (tap(cell, p + e) + tap(cell, p - e))));
}
