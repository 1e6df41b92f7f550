// Blends of a layer with the layers below (LayerBlend of engine/surface/layers.h), whose picture is a copy of this one.
layout(binding = 11) uniform sampler2D picture_below;

// The colour of the ground before light and air, which finish() adds again. Lamps, and the Sun in the sea, may make the
// colour brighter than 1.
vec3 color_below() {
  vec3 seen_srgb = texelFetch(picture_below, ivec2(gl_FragCoord.xy), 0).rgb;
  if (layer_look.w > 0.0) return seen_srgb;
  vec3 color = before_air(seen_srgb);
  if (layer_look.x < 0.0) return color;
  return max(color - lit(vec3(0.0), 1.0, false), 0.0) / max(lit(vec3(1.0), 0.0, false), 1e-3);
}

// A premultiplied colour.
vec3 blended(vec3 imagery_srgb, float alpha) {
  vec3 below = color_below(), own = imagery_srgb / max(alpha, 1e-3);
  vec3 both = limb.z < 1.5 ? below * own : limb.z < 2.5 ? below + own - below * own : abs(below - own);
  return both * alpha;
}
