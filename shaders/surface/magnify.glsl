#if defined(BICUBIC)
// Catmull-Rom's bicubic filter in five bilinear look-ups: the middle two texels of a row, and of a column, lie under one
// look-up. The four corners, each under 1/180, are left out.
Imagery bicubic_tap(Cell cell, vec2 p) {
  vec3 at = slot_point(cell, p);
  float slot_px = texels.y;
  vec2 texel = at.xy * slot_px - 0.5;
  vec2 f = fract(texel), g = 1.0 - f;
  vec2 before = -0.5 * f * g * g, after = -0.5 * f * f * g, second = f * (0.5 + f * (2.0 - 1.5 * f));
  vec2 middle = 1.0 - before - after;
  vec2 whole = floor(texel) + 0.5;
  vec2 p0 = (whole - 1.0) / slot_px, p1 = (whole + second / middle) / slot_px, p3 = (whole + 2.0) / slot_px;
  vec4 sum = middle.x * middle.y * textureLod(tiles_precise, vec3(p1, at.z), 0.0);
  sum += before.x * middle.y * textureLod(tiles_precise, vec3(p0.x, p1.y, at.z), 0.0);
  sum += after.x * middle.y * textureLod(tiles_precise, vec3(p3.x, p1.y, at.z), 0.0);
  sum += middle.x * before.y * textureLod(tiles_precise, vec3(p1.x, p0.y, at.z), 0.0);
  sum += middle.x * after.y * textureLod(tiles_precise, vec3(p1.x, p3.y, at.z), 0.0);
  vec4 texel_sum = sum / (middle.x * middle.y + (before.x + after.x) * middle.y + middle.x * (before.y + after.y));
  float alpha = clamp(texel_sum.a, 0.0, 1.0);
  return IMAGERY(vec4(clamp(texel_sum.rgb, 0.0, alpha), alpha));
}
#endif
