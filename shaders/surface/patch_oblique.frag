// Patches seen at a slant or squeezed towards a pole, with interpolated coordinates. The pixel's footprint may be a long
// parallelogram. Up to 16 taps integrate it. Most pixels are short: their three taps are written out, which costs far
// less than a loop.

// Sine of the polar distance up to which texels are narrow without a slant: there three taps reach over two texels only.
const float kBesidePole = 0.1564;              // 9 degrees
const float kThreeBesidePole_texels = 2.0;

Texels tap_at(Cell cell, Lattice lattice, int i, vec2 a, vec2 b) {
  vec2 at = place(lattice, i);
  return precise_tap(cell, window_point + at.x * a + at.y * b);
}

void main() {
  vec2 a = dFdx(window_point), b = dFdy(window_point);
  Cell cell = cell_at(window_point);
  float long_texels = length_texels(a, b, cell);
  Lattice lattice = lattice_of(long_texels), short_one = lattice_of(0.0);
  Texels three = tap_at(cell, short_one, 0, a, b) + tap_at(cell, short_one, 1, a, b) + tap_at(cell, short_one, 2, a, b);
  int n = long_texels > (frame.z < kBesidePole ? kThreeBesidePole_texels : surface_look.z) ? lattice.n : 0;
  Texels many = Texels(0.0);
  for (int i = 0; i < n; ++i) many += tap_at(cell, lattice, i, a, b);
  finish(seen(n == 0 ? three * short_one.step : many * lattice.step));
}
