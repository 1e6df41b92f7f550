// Look-ups shared by all ways of texturing a patch.
layout(binding = 0) uniform sampler2DArray tiles;           // bilinear, finest texels only
layout(binding = 1) uniform samplerBuffer window_cells;     // scale, offset x, offset y, layer

in vec2 window_point;
in vec3 row_direction;
in float light;
flat in uvec4 window;            // first cell, cells a row, width, height
flat in vec4 center_and_scale;
flat in vec4 frame;
flat in vec4 row;
layout(location = 0) out vec4 color_srgb;

vec4 cell_at(vec2 p) {
  ivec2 c = ivec2(p);
  return texelFetch(window_cells, int(window.x) + c.y * int(window.y) + c.x);
}

vec3 tap(vec4 cell, vec2 p) {
  return textureLod(tiles, vec3(p * cell.x + cell.yz, cell.w), 0.0).rgb;
}

void finish(vec3 imagery_srgb) {
  color_srgb = vec4(imagery_srgb * light, 1.0);
#if defined(DEPTH_LOGARITHMIC)
  float w = 1.0 / gl_FragCoord.w;
  gl_FragDepth = log2(w / clip_scale.z + 1.0) / log2(clip_scale.w / clip_scale.z + 1.0);
#endif
}
