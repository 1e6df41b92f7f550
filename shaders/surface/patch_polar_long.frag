// As patch_polar_short.frag, for longer pixels: near a pole the pixel's footprint is long in longitude.

// Texels are narrow there, but imagery has no finer detail than elsewhere. So a pixel that is short along the meridian
// needs no more taps than this many times its length there.
const float kMostOverMeridian = 6.0;

void main() {
  WindowPoint w = exact_window_point();
  Cell cell = cell_at(w.p);
  float meridian_texels = length(vec2(w.dx.y, w.dy.y)) * cell.scale.y * texels.y;
  float long_texels = min(length_texels(w.dx, w.dy, cell), kMostOverMeridian * meridian_texels);
  finish(seen(polar_mean(w, lattice_of(max(long_texels, float(kSeven.n))))));
}
