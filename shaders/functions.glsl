// Angle functions that determine a texel's position. GLSL promises no accuracy, and a driver's functions may be coarse.
// The engine measures them once and defines OWN_FUNCTIONS if they are (engine/render/gl/shader_functions.h). The
// polynomials are minimax, by iteratively reweighted least squares. Each has an error below a float's rounding.
#if defined(OWN_FUNCTIONS)
float own_atan(float y, float x) {
  float a = abs(x), b = abs(y), large = max(a, b), small = min(a, b);
  bool over = small > 0.41421356 * large;   // tan 22.5 degrees: above it, subtracting 45 degrees leaves a small rest
  precise float t = over ? (small - large) / (small + large) : small / max(large, 1e-37);
  float z = t * t;
  float p = t + t * z * (-0.33332955 + z * (0.19977926 + z * (-0.13879850 + z * 0.08060308)));
  if (over) p += 0.78539816;
  if (b > a) p = 1.57079633 - p;
  if (x < 0.0) p = 3.14159265 - p;
  return y < 0.0 ? -p : p;
}

// Valid up to a turn either way. Subtracts a multiple of a quarter turn in two parts, the first of which has few
// digits.
vec2 own_sin_cos(float angle) {
  float quarters = floor(angle * 0.63661977 + 0.5);
  precise float r = (angle - quarters * 1.5703125) - quarters * 4.8382679e-4;
  float z = r * r;
  float s = r + r * z * (-0.16666655 + z * (0.0083321782 + z * -0.00019517299));
  float c = 1.0 - 0.5 * z + z * z * (0.041666647 + z * (-0.0013887368 + z * 2.4438451e-5));
  int turn = int(quarters) & 3;
  vec2 both = (turn & 1) == 0 ? vec2(s, c) : vec2(c, -s);
  return turn < 2 ? both : -both;
}

float own_inversesqrt(float x) {
  float r = inversesqrt(x);
  r *= 1.5 - 0.5 * x * r * r;               // Newton's step: each doubles the number of digits
  return r * (1.5 - 0.5 * x * r * r);
}

float own_length(vec2 v) {
  float d = dot(v, v);
  return d > 0.0 ? d * own_inversesqrt(d) : 0.0;
}

float own_asin(float x) {
  float s = clamp(x, -1.0, 1.0);
  float c2 = (1.0 - s) * (1.0 + s);
  return own_atan(s, c2 > 0.0 ? c2 * own_inversesqrt(c2) : 0.0);
}

#define ATAN(y, x) own_atan(y, x)
#define ASIN(x) own_asin(x)
#define SIN_COS(angle) own_sin_cos(angle)
#define INVERSESQRT(x) own_inversesqrt(x)
#define LENGTH(v) own_length(v)
#else
#define ATAN(y, x) atan(y, x)
#define ASIN(x) asin(x)
#define SIN_COS(angle) vec2(sin(angle), cos(angle))
#define INVERSESQRT(x) inversesqrt(x)
#define LENGTH(v) length(v)
#endif
