// Patches so near that a pixel lies within one or two texels: one tap, or a bicubic filter, in full precision.
layout(binding = 3) uniform sampler2DArray tiles_precise;

void main() {
  vec3 at = slot_point(cell_at(window_point), window_point);
  finish(IMAGERY(surface_look.x == 0.0 ? textureLod(tiles_precise, at, 0.0) : bicubic_texel(tiles_precise, at, texels.y)));
}
