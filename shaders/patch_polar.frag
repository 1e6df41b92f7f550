// Pole bands, and with `exact` every patch: exact coordinates for each fragment, and its footprint, long in longitude
// near a pole, integrated by up to 16 taps that each find their own cell.
layout(binding = 3) uniform sampler2DArray tiles_precise;

void main() {
  WindowPoint w = exact_window_point();
  vec2 high = vec2(window_size());
  float scale = texels.x * texels.y;
  float reach = sqrt(max(dot(w.dx, w.dx), dot(w.dy, w.dy))) * scale;
  int n = int(clamp(ceil(0.9 * reach), 6.0, 16.0));
  float step = 1.0 / float(n);
  Imagery sum = Imagery(0.0);
  for (int i = 0; i < n; ++i) {
    float s = float(i) + 0.5;
    vec2 p = clamp(w.p + (s * step - 0.5) * w.dx + (fract(s * 0.6180339887) - 0.5) * w.dy, vec2(0.0), high);
    sum += IMAGERY(textureLod(tiles_precise, slot_point(cell_at(p), p), 0.0));
  }
  finish(sum * step);
}
