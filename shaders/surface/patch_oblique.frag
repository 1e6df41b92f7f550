// Patches seen at a slant or squeezed towards a pole, with interpolated coordinates. The pixel's footprint is a long
// parallelogram. Up to 16 taps on a rank-1 lattice integrate it.
void main() {
  vec2 p = window_point;
  Cell cell = cell_at(p);
  vec2 a = dFdx(p), b = dFdy(p);
  vec2 a_texels = a * cell.scale, b_texels = b * cell.scale;
  float reach = sqrt(max(dot(a_texels, a_texels), dot(b_texels, b_texels))) * texels.y;
  int n = int(clamp(ceil(0.8 * reach), 3.0, 16.0));
  float step = 1.0 / float(n);
  Texels sum = Texels(0.0);
  for (int i = 0; i < n; ++i) {
    float s = float(i) + 0.5;
    sum += tap(cell, p + (s * step - 0.5) * a + (fract(s * 0.6180339887) - 0.5) * b);
  }
  finish(seen(sum * step));
}
