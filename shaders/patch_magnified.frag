// Patches seen from so near that a pixel lies within one texel or two: one tap, blended in full precision.
layout(binding = 3) uniform sampler2DArray tiles_precise;

void main() {
  vec4 cell = cell_at(window_point);
  finish(textureLod(tiles_precise, vec3(window_point * cell.x + cell.yz, cell.w), 0.0).rgb);
}
