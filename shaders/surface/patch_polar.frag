// Patches at a pole, and with `exact` every patch: exact coordinates per fragment. Near a pole the pixel's footprint is
// long in longitude. Up to 16 taps integrate it.
void main() {
  WindowPoint w = exact_window_point();
  vec2 high = vec2(window_size());
  Cell cell = cell_at(w.p);
  Lattice lattice = lattice_of(w.dx, w.dy, cell);
  // Taps no further from the pixel's centre than a slot's gutter share the centre's cell. Others find their own.
  vec2 reach_texels = (0.5 * texels.y) * (abs(w.dx) + abs(w.dy)) * cell.scale;
  bool apart = max(reach_texels.x, reach_texels.y) > (0.5 - 0.5 * texels.x) * texels.y - 0.5;
  int apart_taps = apart ? lattice.n : 0;
  Texels sum = Texels(0.0);
  for (int i = apart_taps; i < lattice.n; ++i) {
    vec2 at = place(lattice, i);
    sum += precise_tap(cell, clamp(w.p + at.x * w.dx + at.y * w.dy, vec2(0.0), high));
  }
  for (int i = 0; i < apart_taps; ++i) {
    vec2 at = place(lattice, i);
    vec2 p = clamp(w.p + at.x * w.dx + at.y * w.dy, vec2(0.0), high);
    sum += precise_tap(cell_at(p), p);
  }
  finish(seen(sum * lattice.step));
}
