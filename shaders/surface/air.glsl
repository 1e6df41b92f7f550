// Air in fragments: before the ground, and dithering.

// Less than half a level of eight bits, different from pixel to pixel, so that no gradient shows bands (J. Jimenez,
// "Next generation post processing in Call of Duty: Advanced Warfare", 2014).
float dither() {
  return (fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5) / 255.0;
}

#if defined(AIR)
in vec3 air_through;
in vec3 air_light;
#if defined(NEAR_GROUND)
in vec3 air_tint;
#endif

// A stored colour of lit ground, premultiplied by alpha, seen through the air (GroundColors of
// engine/sky/air_colors.h). Without air the colour stays as it is.
vec3 through_air(vec3 lit_srgb, float alpha) {
#if defined(NEAR_GROUND)
  // The air grows with the distance, from none at the eye. Vertices of a large triangle around the eye give it per
  // metre, and the fragment knows its distance.
  vec2 slope = (gl_FragCoord.xy - axis_px.xy) * axis_px.z;
  float metres = air_metres(sqrt(1.0 + dot(slope, slope)) / gl_FragCoord.w);
  vec3 through = max(vec3(0.0), 1.0 - air_through * metres) * air_tint;
  return sqrt(lit_srgb * lit_srgb * through + air_light * (metres * alpha * alpha)) + dither();
#else
  return sqrt(lit_srgb * lit_srgb * air_through + air_light * (alpha * alpha)) + dither();
#endif
}
#else
vec3 through_air(vec3 lit_srgb, float alpha) { return lit_srgb; }
#endif

#if defined(BLENDED_LAYER)
// The opaque colour that through_air() has made `seen_srgb` of.
vec3 before_air(vec3 seen_srgb) {
#if defined(AIR)
  vec3 through = air_through, light_sq = air_light;
#if defined(NEAR_GROUND)
  vec2 slope = (gl_FragCoord.xy - axis_px.xy) * axis_px.z;
  float metres = air_metres(sqrt(1.0 + dot(slope, slope)) / gl_FragCoord.w);
  through = max(vec3(0.0), 1.0 - air_through * metres) * air_tint;
  light_sq = air_light * metres;
#endif
  return sqrt(max(seen_srgb * seen_srgb - light_sq, 0.0) / max(through, 1e-4));
#else
  return seen_srgb;
#endif
}
#endif
