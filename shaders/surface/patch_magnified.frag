// Patches so near that a pixel lies within one or two texels: one tap in full precision, or with BICUBIC sixteen.
void main() {
  Cell cell = cell_at(window_point);
#if defined(BICUBIC)
  finish(bicubic_tap(cell, window_point));
#else
  finish(seen(precise_tap(cell, window_point)));
#endif
}
