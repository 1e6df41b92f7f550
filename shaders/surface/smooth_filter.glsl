// A cubic B-spline from four bilinear look-ups: two by two of its 16 texels lie under each. C. Sigg, M. Hadwiger, "Fast
// third-order texture filtering", GPU Gems 2, 2005, chapter 20.
struct SmoothTaps {
  vec2 first;   // slot coordinates of the look-ups, western and northern …
  vec2 last;    // … eastern and southern
  vec2 low;     // weight of the first
};

SmoothTaps smooth_taps(vec2 at, float slot_px) {
  vec2 texel = at * slot_px - 0.5;
  vec2 f = fract(texel), g = 1.0 - f;
  vec2 w0 = g * g * g / 6.0, w3 = f * f * f / 6.0;
  vec2 low = (4.0 - 3.0 * f * f * (2.0 - f)) / 6.0 + w0;
  return SmoothTaps((floor(texel) + 0.5 - w0 / low) / slot_px, (floor(texel) + 1.5 + w3 / (1.0 - low)) / slot_px, low);
}

#define SMOOTH_TEXTURE(result, map, at, slot_px)                                                                     \
  {                                                                                                                  \
    SmoothTaps t = smooth_taps((at).xy, slot_px);                                                                    \
    result = mix(mix(textureLod(map, vec3(t.last, (at).z), 0.0),                                                     \
                     textureLod(map, vec3(t.first.x, t.last.y, (at).z), 0.0), t.low.x),                              \
                 mix(textureLod(map, vec3(t.last.x, t.first.y, (at).z), 0.0),                                        \
                     textureLod(map, vec3(t.first, (at).z), 0.0), t.low.x),                                          \
                 t.low.y);                                                                                           \
  }
