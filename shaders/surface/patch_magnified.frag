// Patches so near that a pixel lies within one or two texels: one tap, blended in full precision.
void main() {
  Cell cell = cell_at(window_point);
  finish(seen(precise_tap(cell, window_point)));
}
