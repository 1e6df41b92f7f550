#if defined(BICUBIC)
// Weights of four texels in a row for a position between the second and the third, by Catmull and Rom.
vec4 cubic_weights(float f) {
  float g = 1.0 - f;
  return vec4(-0.5 * f * g * g, g * (0.5 + g * (2.0 - 1.5 * g)), f * (0.5 + f * (2.0 - 1.5 * f)), -0.5 * f * f * g);
}

// Catmull-Rom's bicubic filter. No value is outside of those of its texels, so that no dark rim lies beside snow.
Imagery bicubic_tap(Cell cell, vec2 p) {
  vec3 at = slot_point(cell, p);
  vec2 texel = at.xy * texels.y - 0.5;
  ivec2 first = ivec2(floor(texel)) - 1, last = ivec2(int(texels.y) - 1);
  int slot = int(at.z + 0.5);
  vec4 across = cubic_weights(fract(texel.x)), down = cubic_weights(fract(texel.y));
  vec4 sum = vec4(0.0), least = vec4(1.0), most = vec4(0.0);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      ivec2 place = clamp(first + ivec2(column, row), ivec2(0), last);
      vec4 value = texelFetch(tiles_precise, ivec3(place, slot), 0);
      sum += across[column] * down[row] * value;
      least = min(least, value);
      most = max(most, value);
    }
  }
  vec4 seen_sum = clamp(sum, least, most);
  return IMAGERY(vec4(min(seen_sum.rgb, seen_sum.a), seen_sum.a));
}
#endif
