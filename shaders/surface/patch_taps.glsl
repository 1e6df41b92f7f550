// Look-ups in the tiles of one layer. Taps return Texels, which can be added and weighed; seen() makes imagery of their
// mean. Texels are colours or, with NUMBERS, numbers, which are filtered first and coloured by seen(). A stack has this
// text once for each of its layers, with other names (PatchPass::make_stack_program()).
#if !defined(STACK)
in vec2 window_point;
flat in vec4 center_and_scale;
flat in uvec4 window;            // first cell; width | height << 16; column and row of that cell, low bits
layout(binding = 0) uniform sampler2DArray tiles;           // bilinear, only the finest texels
layout(binding = 2) uniform sampler2DArray tiles_mipmapped;
layout(binding = 3) uniform sampler2DArray tiles_precise;
layout(binding = 4) uniform sampler2D number_colors;        // premultiplied; 0 to 1 is the stretch
// Texel without data; how far other texels are from it at least; position in the stretch = texel * z + w.
layout(location = 0) uniform vec4 number_look;
// Contour lines: steps from 0 = texel * x + y; half the width of a line, pixels, or 0 without lines. Radians of a texel
// of directions; 0: no directions.
layout(location = 24) uniform vec4 number_lines;
#endif

ivec2 window_size() { return ivec2(window.y & 0xFFFFu, window.y >> 16); }

vec3 slot_point(Cell cell, vec2 p) { return vec3(p * cell.scale + cell.offset, cell.layer); }

// Returns the cell under a window point. A cell is one word: a fetch of four floats costs a software rasteriser as much
// as two bilinear taps.
Cell cell_at(vec2 p) {
  ivec2 size = window_size();
  ivec2 c = clamp(ivec2(p), ivec2(0), size - 1);
  uint bits = texelFetch(window_cells, int(window.x) + c.y * size.x + c.x).x;
  uvec2 up = uvec2(bits >> 24, (bits >> 16) & 0xFFu);
  uvec2 part = (window.zw + uvec2(c)) & ((uvec2(1u) << up) - 1u);  // selects one of the tile's 2^up.x by 2^up.y parts
  vec2 scale = texels.x * uintBitsToFloat((127u - up) << 23);      // 2^-up
  vec2 corner = 0.5 * (texels.z - texels.x) + texels.z * vec2((bits >> 12) & 3u, (bits >> 14) & 3u);
  return Cell(scale, corner + scale * (vec2(part) - vec2(c)), float(bits & 0xFFFu));
}

#if defined(NUMBERS)
// Sum of texel times weight, sum of weights; known texels only. Of directions: sums of sine and cosine times weight.
#define Texels vec2

vec2 known(vec4 texel, vec4 weight) {
  vec4 share = weight * vec4(greaterThan(abs(texel - number_look.x), vec4(number_look.y)));
#if defined(DIRECTIONS)
  vec4 angle = mix(vec4(0.0), texel, greaterThan(share, vec4(0.0))) * number_lines.w;
  return vec2(dot(sin(angle), share), dot(cos(angle), share));
#else
  return vec2(dot(texel, share), dot(vec4(1.0), share));
#endif
}

// Weights of the texels of textureGather().
vec4 bilinear(vec2 f) {
  return vec4(1.0 - f.x, f.x, f.x, 1.0 - f.x) * vec4(f.y, f.y, 1.0 - f.y, 1.0 - f.y);
}

// Gathers at the corner that four texels share, so that no rounding can choose others.
vec2 tap(Cell cell, vec2 p) {
  vec3 at = slot_point(cell, p);
  vec2 texel = at.xy * texels.y - 0.5, first = floor(texel);
  return known(textureGather(tiles, vec3((first + 1.0) / texels.y, at.z)), bilinear(texel - first));
}

#define precise_tap tap

vec2 level_tap(vec3 at, int level) {
  ivec2 last = ivec2((int(texels.y) >> level) - 1);  // textureSize() may take one level for several fragments
  vec2 texel = at.xy * vec2(last + 1) - 0.5, first = floor(texel);
  ivec2 a = clamp(ivec2(first), ivec2(0), last), b = clamp(ivec2(first) + 1, ivec2(0), last);
  int slot = int(at.z);
  vec4 four = vec4(texelFetch(tiles, ivec3(a.x, b.y, slot), level).r, texelFetch(tiles, ivec3(b, slot), level).r,
                   texelFetch(tiles, ivec3(b.x, a.y, slot), level).r, texelFetch(tiles, ivec3(a, slot), level).r);
  return known(four, bilinear(texel - first));
}

vec2 mip_tap(Cell cell, vec2 p, float level) {
  vec3 at = slot_point(cell, p);
  int finer = int(level);
  return mix(level_tap(at, finer), level_tap(at, min(finer + 1, kSlotMips - 1)), fract(level));
}

// Adds contour lines, dark on light colours and light on dark ones; every fifth has twice the width. Lines less than four
// pixels apart fade, and a flat place at the value of a line has none: its differences are those of rounding.
vec4 with_lines(vec4 color, float steps) {
  float a_pixel = length(vec2(dFdx(steps), dFdy(steps))), line = round(steps);
  float half_width_px = number_lines.z * (mod(line, 5.0) == 0.0 ? 2.0 : 1.0);
  float cover = clamp(half_width_px + 0.5 - abs(steps - line) / max(a_pixel, 1e-6), 0.0, 1.0);
  cover *= step(1e-4, a_pixel) * (1.0 - smoothstep(0.25, 0.5, a_pixel));
  vec4 ink = vec4(vec3(1.0 - step(0.4, dot(color.rgb, vec3(0.299, 0.587, 0.114)))), 1.0);
  return mix(color, ink, 0.75 * cover);
}

// Colour of a mean; clear if less than half of the weight has data. A direction is clear where no texel has one.
Imagery seen(vec2 mean) {
#if defined(DIRECTIONS)
  float angle = atan(mean.x, mean.y);
  float number = (angle < 0.0 ? angle + 6.28318531 : angle) / number_lines.w;
  mean.y = step(1e-4, dot(mean, mean));
#else
  float number = mean.x / max(mean.y, 1e-6);
#endif
  vec4 color = textureLod(number_colors, vec2(number * number_look.z + number_look.w, 0.5), 0.0);
  if (number_lines.z > 0.0) color = with_lines(color, number * number_lines.x + number_lines.y);
  color *= step(0.5, mean.y);
#if defined(UPPER_LAYER)
  return color;
#else
  return color.rgb + (1.0 - color.a) * vec3(30.0, 38.0, 52.0) / 255.0;  // the plain colour of tile_textures.cpp
#endif
}
#else
#define Texels Imagery
#define seen(mean) (mean)

Texels tap(Cell cell, vec2 p) { return IMAGERY(textureLod(tiles, slot_point(cell, p), 0.0)); }
Texels precise_tap(Cell cell, vec2 p) { return IMAGERY(textureLod(tiles_precise, slot_point(cell, p), 0.0)); }
Texels mip_tap(Cell cell, vec2 p, float level) {
  return IMAGERY(textureLod(tiles_mipmapped, slot_point(cell, p), level));
}
#endif

float length_texels(vec2 a, vec2 b, Cell cell) {
  vec2 a_slot = a * cell.scale, b_slot = b * cell.scale;
  return sqrt(max(dot(a_slot, a_slot), dot(b_slot, b_slot))) * texels.y;
}
