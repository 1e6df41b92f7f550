// Patches at a pole, and with `exact` every patch: exact coordinates per fragment. Near a pole the pixel's footprint is
// long in longitude.

// Texels are narrow there, but imagery has no finer detail than elsewhere. So a pixel that is short along the meridian
// needs no more taps than this many times its length there.
const float kMostOverMeridian = 6.0;
// Least number of taps where they lie in several cells: around the pole itself.
const float kApart_texels = 7.0;

void main() {
  WindowPoint w = exact_window_point();
  vec2 high = vec2(window_size());
  Cell cell = cell_at(w.p);
  float long_texels = length_texels(w.dx, w.dy, cell);
  float meridian_texels = length(vec2(w.dx.y, w.dy.y)) * cell.scale.y * texels.y;
  // Taps no further from the pixel's centre than a slot's gutter share the centre's cell. Others find their own.
  vec2 reach_texels = (0.5 * texels.y) * (abs(w.dx) + abs(w.dy)) * cell.scale;
  bool apart = max(reach_texels.x, reach_texels.y) > (0.5 - 0.5 * texels.x) * texels.y - 0.5;
  Lattice lattice = lattice_of(max(min(long_texels, kMostOverMeridian * meridian_texels), apart ? kApart_texels : 0.0));
  // Most pixels are short: their three taps are written out, which costs far less than a loop.
  vec2 a = w.dx * (1.0 / 3.0), b = w.dy * (1.0 / 3.0);
  Texels three = precise_tap(cell, in_window(w.p - a, high)) + precise_tap(cell, in_window(w.p + b, high)) +
                 precise_tap(cell, in_window(w.p + a - b, high));
  int n = lattice.n > 3 ? lattice.n : 0;
  Texels many = Texels(0.0);
  for (int i = 0; i < n; ++i) {
    vec2 at = place(lattice, i);
    vec2 p = in_window(w.p + at.x * w.dx + at.y * w.dy, high);
    many += precise_tap(cell_at(p), p);
  }
  finish(seen(n == 0 ? three * (1.0 / 3.0) : many * lattice.step));
}
