// The ground of a pixel on the limb, or next to it: triangles that PatchPass chooses and patch.vert raises. The part of the
// pixel inside the limb is integrated, by places in the picture whose ground is known. AT_POLE: coordinates are exact.

// A pixel at the limb. Places on the ground change evenly with the cosine towards the eye, and the square of the cosine
// changes evenly with the distance from the limb in the picture.
struct LimbPixel {
  float square;                  // at the pixel's middle
  vec2 slope;                    // its change along the pixel's sides
  vec2 steps;                    // change of towards_eye, as interpolated, along the sides
};
const Lattice kAtLimb = Lattice(16, 1.0 / 16.0, 7.0 / 16.0);

// `steps`: change of towards_eye across the pixel.
LimbPixel limb_pixel(vec2 steps) {
  vec2 d = gl_FragCoord.xy - limb_at_px.xy, t = (gl_FragCoord.xy - axis_px.xy) * axis_px.z;
  vec2 bend = vec2(limb_bend.x * d.x + limb_bend.y * d.y, limb_bend.z * d.y);
  float to_square = 1.0 / (1.0 + dot(t, t));
  vec2 slope = (limb_at_px.zw + bend + vec2(limb_bend.x * d.x, limb_bend.y * d.x + limb_bend.z * d.y)) * to_square;
  return LimbPixel((limb_bend.w + dot(limb_at_px.zw + bend, d)) * to_square, slope, steps);
}

// Moves a place of the pixel inside the limb, along the steeper of the pixel's sides. z: the share of the line of places
// along that side that lies inside.
vec3 inside_limb(LimbPixel pixel, vec2 at) {
  vec2 slope = pixel.slope;
  bool along_x = abs(slope.x) > abs(slope.y);
  if (along_x) { slope = slope.yx; at = at.yx; }
  float steep = max(abs(slope.y), 1e-30), middle = pixel.square + slope.x * at.x;
  float low = max(middle - 0.5 * steep, 0.0), high = max(middle + 0.5 * steep, low + 1e-3 * steep);
  at.y = (mix(low, high, at.y + 0.5) - middle) / (slope.y < 0.0 ? -steep : steep);
  return vec3(along_x ? at.yx : at, (high - low) / steep);
}

// The place, along the pixel's sides, whose interpolated values are those of the ground at a place of the pixel.
vec2 on_ground(LimbPixel pixel, vec2 at) {
  float cosine = sqrt(max(pixel.square + dot(pixel.slope, at), 0.0));
  return at + (cosine - towards_eye - dot(pixel.steps, at)) * pixel.steps / max(dot(pixel.steps, pixel.steps), 1e-30);
}

#if defined(AT_POLE)
vec2 ground_point(vec2 at) {
  vec3 direction = row_direction + at.x * dFdx(row_direction) + at.y * dFdy(row_direction);
  return in_window(exact_point(direction).p, vec2(window_size()));
}
#else
vec2 ground_point(vec2 at) { return window_point + at.x * dFdx(window_point) + at.y * dFdy(window_point); }
#endif

void main() {
  LimbPixel pixel = limb_pixel(vec2(dFdx(towards_eye), dFdy(towards_eye)));
  Texels sum = Texels(0.0);
  float shares = 0.0;
  for (int i = 0; i < kAtLimb.n; ++i) {
    vec3 at = inside_limb(pixel, place(kAtLimb, i));
    vec2 p = ground_point(on_ground(pixel, at.xy));
    sum += at.z * tap(cell_at(p), p);
    shares += at.z;
  }
  finish(seen(sum / shares));
}
