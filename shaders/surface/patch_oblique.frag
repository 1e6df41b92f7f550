// Patches seen at a slant or squeezed towards a pole, with interpolated coordinates. The pixel's footprint is a long
// parallelogram. Up to 16 taps integrate it.
void main() {
  vec2 p = window_point, a = dFdx(p), b = dFdy(p);
  Cell cell = cell_at(p);
  Lattice lattice = lattice_of(a, b, cell);
  Texels sum = Texels(0.0);
  for (int i = 0; i < lattice.n; ++i) {
    vec2 at = place(lattice, i);
    sum += precise_tap(cell, p + at.x * a + at.y * b);
  }
  finish(seen(sum * lattice.step));
}
