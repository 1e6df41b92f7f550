layout(binding = 0) uniform sampler2D atlas;     // premultiplied by alpha
layout(location = 3) uniform vec2 alpha_range;   // drawn from the first to before the second
in vec2 at_px;
flat in vec2 sides_px;
flat in vec4 place;
flat in float texels_of_pixel;
flat in vec4 tint;
flat in vec4 wash;
flat in float pull;
layout(location = 0) out vec4 color_srgb;        // premultiplied by alpha

void main() {
  vec2 covered = clamp(0.5 + min(at_px, sides_px - at_px), 0.0, 1.0);
  vec2 texel = place.xy + clamp(at_px * texels_of_pixel, vec2(0.0), place.zw);
  vec4 seen = textureLod(atlas, texel / vec2(textureSize(atlas, 0)), max(log2(texels_of_pixel), 0.0));
  seen *= vec4(tint.rgb * tint.a, tint.a) * (covered.x * covered.y);
  if (seen.a <= 0.0 || seen.a < alpha_range.x || seen.a >= alpha_range.y) discard;
  color_srgb = vec4(mix(seen.rgb, wash.rgb * seen.a, wash.a), seen.a);
  WRITE_DEPTH(pull);
}
