// Pole bands, and with `exact` every patch: exact coordinates per fragment. Near a pole the pixel's footprint is long
// in longitude. Up to 16 taps, each with its own cell, integrate it.

// A lattice of n places in the pixel, evenly spaced along each side and without an offset: place i is (i, i times this
// modulo n). From n = 7 on, this number and n have no common divisor.
const int stride_of[17] = int[](1, 1, 1, 1, 1, 2, 1, 3, 3, 4, 3, 4, 5, 5, 5, 4, 7);

void main() {
  WindowPoint w = exact_window_point();
  vec2 high = vec2(window_size());
  float scale = texels.x * texels.y;
  float reach = sqrt(max(dot(w.dx, w.dx), dot(w.dy, w.dy))) * scale;
  int n = int(clamp(ceil(0.9 * reach), 7.0, 16.0));
  float step = 1.0 / float(n);
  int stride = stride_of[n];
  Texels sum = Texels(0.0);
  for (int i = 0; i < n; ++i) {
    float s = float(i) + 0.5;
    float t = float((i * stride) % n) + 0.5;
    vec2 p = in_window(w.p + (s * step - 0.5) * w.dx + (t * step - 0.5) * w.dy, high);
    sum += precise_tap(cell_at(p), p);
  }
  finish(seen(sum * step));
}
