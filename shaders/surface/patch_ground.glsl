// Areas and lines on the ground, from the pictures of a patch (GroundPicture of
// engine/objects/ground/ground_picture.h, GroundFrame of engine/render/surface/ground_textures.h).
layout(binding = 0) uniform sampler2DArray ground_fill;      // premultiplied
layout(binding = 2) uniform usampler2DArray ground_line;
layout(binding = GROUND_CELLS) uniform usamplerBuffer ground_cells;
in vec2 ground_point;
in float object_light;
flat in uvec4 ground_window;

const float kPictureSide = 256.0, kPictureRim = 4.0;
// Over longer pixels a line is a ribbon on the ground, and fades, or the lines near the limb would run together, and
// lines behind a crest would show before it.
const float kLongestFullPixel = 6.0;

// Texels of the coarsest mip. A third of a pixel on a crest is often longer, and then lies far behind the crest.
const float kLongestThird = 16.0;

// A picture's texels under a pixel: the place of its middle, and the changes along its sides.
struct OnPicture {
  vec2 at, a, b;
};

vec4 fill_tap(float slot, vec2 at, float level) {
  return textureLod(ground_fill, vec3(at / kPictureSide, slot), level);
}

// The areas under a pixel. A pixel at a slant is longer than wide.
vec4 areas_on(OnPicture p, float slot) {
#if defined(SLANTED)
  float along_a = dot(p.a, p.a), along_b = dot(p.b, p.b);
  vec2 third = (along_a > along_b ? p.a : p.b) / 3.0;
  float long_sq = max(dot(third, third), 1.0);
  third *= min(1.0, kLongestThird * inversesqrt(long_sq));
  float level = 0.5 * log2(long_sq);
  vec4 mean = (fill_tap(slot, p.at - third, level) + fill_tap(slot, p.at, level) + fill_tap(slot, p.at + third, level)) / 3.0;
#else
  vec4 mean = fill_tap(slot, p.at, 0.0);
#endif
  return vec4(mean.rgb * object_light, mean.a);
}

// A line at a pixel. Its distance is measured on the screen, so its width holds at a slant: across the line, and from
// the point at an end of a piece.
vec4 line_on(OnPicture p, uvec2 line, float reach) {
  uvec4 parts = (uvec4(line.y) >> uvec4(23u, 12u, 6u, 0u)) & uvec4(511u, 1023u, 63u, 63u);
  float half_width = relief.w * float(parts.x) / 8.0;
  vec2 across = vec2(parts.zw) * vec2(1.0 / 31.0, 1.0 / 63.0) - vec2(32.0 / 31.0, 0.0);
  vec2 from_middle = p.at - (floor(p.at) + 0.5);
  float distance = (float(parts.y) - 512.0) * (reach / 511.0), away = dot(across, from_middle) - distance;
  vec2 per_px = vec2(dot(across, p.a), dot(across, p.b));
  float px = inversesqrt(max(dot(per_px, per_px), 1e-12)), away_px = abs(away) * px;
#if defined(SLANTED)
  float size = abs(p.a.x * p.b.y - p.a.y * p.b.x), long_sq = max(max(dot(p.a, p.a), dot(p.b, p.b)), 1e-12);
  vec2 to_end = distance * across - from_middle;
  vec2 end_px = vec2(to_end.x * p.b.y - to_end.y * p.b.x, to_end.y * p.a.x - to_end.x * p.a.y);
  away_px = (line.y & (1u << 22)) == 0u ? away_px : length(end_px) / max(size, 1e-12);
  half_width *= min(1.0, kLongestFullPixel * size * inversesqrt(long_sq) * px);
  float shown = min(1.0, kLongestFullPixel * size / long_sq);
#else
  const float shown = 1.0;
#endif
  float coverage = clamp(0.5 + half_width - away_px, 0.0, 1.0) * min(1.0, 2.0 * half_width) * shown;
  uvec4 bytes = (uvec4(line.x) >> uvec4(0u, 8u, 16u, 24u)) & 255u;
  float alpha = float(bytes.w) / 255.0 * coverage;
  return vec4(vec3(bytes.xyz) / 255.0 * alpha, alpha);
}

// The lines of a sheet at a pixel, over a colour.
vec4 under_line(vec4 sum, OnPicture p, uint slot, float reach) {
  uvec2 line = texelFetch(ground_line, ivec3(ivec2(p.at), slot == 65535u ? 0u : slot), 0).xy;
  vec4 seen = line_on(p, line * (slot == 65535u ? 0u : 1u), reach);
  return seen + (1.0 - seen.a) * sum;
}

// Objects on the ground of the pixel, premultiplied.
vec4 on_ground() {
  float side = float(1u << ground_window.y);
  vec2 p = clamp(ground_point, 0.0, 1.0) * side, cell = min(floor(p), side - 1.0);
  uvec3 words = texelFetch(ground_cells, int(ground_window.x) + int(cell.y * side + cell.x)).xyz;
  float part = uintBitsToFloat((127u - (words.y & 15u)) << 23) * (kPictureSide - 2.0 * kPictureRim);  // texels of a cell
  vec2 first = vec2((words.y >> 4) & 4095u, (words.y >> 16) & 4095u);
  OnPicture there = OnPicture((p - cell + first) * part + kPictureRim, dFdx(ground_point) * (side * part),
                              dFdy(ground_point) * (side * part));
  vec4 sum = vec4(0.0);
#if defined(AREAS)
  uint fill_slot = words.x & 65535u;
  sum = areas_on(there, float(fill_slot)) * (fill_slot == 65535u ? 0.0 : 1.0);
#endif
#if defined(LINES)
  float reach = uintBitsToFloat((129u + (words.y >> 28)) << 23);
#if defined(MORE_LINES)
  sum = under_line(sum, there, words.z >> 16, reach);
  sum = under_line(sum, there, words.z & 65535u, reach);
#endif
  sum = under_line(sum, there, words.x >> 16, reach);
#endif
  return sum;
}

// Seen through the air.
vec4 objects_seen() {
  vec4 sum = on_ground();
  return sum.a > 0.0 ? vec4(through_air(sum.rgb, sum.a), sum.a) : vec4(0.0);
}

vec4 under_objects(vec4 ground_srgb) {
  vec4 objects = objects_seen();
  return objects + (1.0 - objects.a) * ground_srgb;
}
