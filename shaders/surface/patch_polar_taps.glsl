// Mean of the taps of a pixel with exact coordinates. Around a pole a pixel reaches over several cells, so each tap finds
// its own.
Texels polar_mean(WindowPoint w, Lattice lattice) {
  vec2 high = vec2(window_size());
  Texels sum = Texels(0.0);
  for (int i = 0; i < lattice.n; ++i) {
    vec2 at = place(lattice, i);
    vec2 p = in_window(w.p + at.x * w.dx + at.y * w.dy, high);
    sum += precise_tap(cell_at(p), p);
  }
  return sum * lattice.step;
}
