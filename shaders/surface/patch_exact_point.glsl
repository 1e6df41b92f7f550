// Computes the window point of a fragment from its direction, and its change across a pixel. All differences are
// relative to the patch's centre, where the floats are small, so the point is accurate to the patch's own resolution.

struct WindowPoint {
  vec2 p;
  vec2 dx;
  vec2 dy;
};

const float kDegrees = 57.29577951308232;

// Components of a direction to the east, outward and to the pole, in the meridian of the centre.
vec3 in_meridian(vec3 d) {
  return vec3(frame.x * d.y - frame.y * d.x, frame.x * d.x + frame.y * d.y, d.z);
}

// The window point of a direction from the patch's centre, and what its change across a pixel follows from.
struct ExactPoint {
  vec2 p;
  vec3 place;                    // outward, to the east and to the pole, in the meridian of the centre
  float r;                       // distance from the axis
};

ExactPoint exact_point(vec3 direction) {
  float c = frame.z, s = frame.w;                // cosine and sine of the centre's latitude
  vec3 d = in_meridian(direction);               // small
  float x = c + d.y, y = d.x, z = s + d.z;
  float r = LENGTH(vec2(x, y));
  float r_minus_c = (d.y * (x + c) + y * y) / (r + c);
  float north = d.z * c - r_minus_c * s;         // sine of the polar angle from the centre
  float along = z * s + r * c;
  float lat = ATAN(north, along);
  float lon = ATAN(y, x);
  float row_offset = lat;
  if (paper.z > 0.5) {
    // Equal-area rows count the sine: 90° (sin a - sin b) = 180° cos((a + b)/2) sin((a - b)/2).
    vec2 half_angle = SIN_COS(0.5 * lat);
    row_offset = 3.141592653589793 * (c * half_angle.y - s * half_angle.x) * half_angle.x;
  }
  return ExactPoint(center_and_scale.xy + vec2(lon, -row_offset) * (center_and_scale.zw * kDegrees), vec3(x, y, z), r);
}

WindowPoint exact_window_point() {
  ExactPoint point = exact_point(row_direction);
  float x = point.place.x, y = point.place.y, z = point.place.z, r = point.r;
  vec3 ddx = in_meridian(dFdx(row_direction)), ddy = in_meridian(dFdy(row_direction));
  float r2 = max(r * r, 1e-30), q2 = r2 + z * z;
  vec2 dlon = vec2(x * ddx.x - y * ddx.y, x * ddy.x - y * ddy.y) / r2;
  vec2 dr = vec2(x * ddx.y + y * ddx.x, x * ddy.y + y * ddy.x) / max(r, 1e-15);
  vec2 dlat = (r * vec2(ddx.z, ddy.z) - z * dr) / q2;
  float drow_dlat = paper.z > 0.5 ? 1.5707963267948966 * r / sqrt(q2) : 1.0;
  vec2 per_radian = center_and_scale.zw * kDegrees;
  return WindowPoint(point.p, vec2(dlon.x, -dlat.x * drow_dlat) * per_radian,
                     vec2(dlon.y, -dlat.y * drow_dlat) * per_radian);
}

// A place of the pixel in the window. At the limb a pixel may reach far over its patch: the taps outside are mirrored
// into it, for at its edge they would all see one texel. Imagery alone keeps to the edge, which measurements compare.
vec2 in_window(vec2 p, vec2 high) {
  if (sun_ecef.w > 0.0) p = high - abs(high - abs(p));
  return clamp(p, vec2(0.0), high);
}
