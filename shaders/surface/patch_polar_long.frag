// As patch_polar_short.frag, for longer pixels: near a pole the pixel's footprint is long in longitude. In a lit picture
// this also replaces patch_polar.frag, because at the limb pixels are long in any direction.

// Texels are narrow there, but imagery has no finer detail than elsewhere. So a pixel needs no more taps than this many
// times its true length.
const float kMostOverTrue = 6.0;
// Beyond a pole the limb's pixels are over a hundred texels long. Imagery alone keeps to 16 taps, which measurements
// compare.
const float kMostTapsLit = 48.0;
const float kGolden = 0.618034;                // spreads any number of places evenly

// Length of the pixel, in texels along the meridian.
float true_texels(vec2 dy, Cell cell) {
  vec3 a = dFdx(row_direction), b = dFdy(row_direction);
  float length_cells = sqrt(max(dot(a, a), dot(b, b))) * kDegrees * center_and_scale.w;
  return (sun_ecef.w > 0.0 ? length_cells : length(dy)) * cell.scale.y * texels.y;
}

void main() {
  WindowPoint w = exact_window_point();
  Cell cell = cell_at(w.p);
  float most = kMostOverTrue * true_texels(vec2(w.dx.y, w.dy.y), cell);
  float long_texels = min(length_texels(w.dx, w.dy, cell), most);
  Lattice lattice;
  if (sun_ecef.w == 0.0) {
    lattice = lattice_of(max(long_texels, float(kSeven.n)));
  } else {
    lattice = lattice_of(long_texels);
    float n = min(ceil(0.9 * long_texels), kMostTapsLit);
    if (n > 16.0) lattice = Lattice(int(n), 1.0 / n, kGolden);
  }
  finish(seen(polar_mean(w, lattice)));
}
