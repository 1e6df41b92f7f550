// Patches so near that a pixel lies within one or two texels: one tap, blended in full precision.
layout(binding = 3) uniform sampler2DArray tiles_precise;

void main() {
  Cell cell = cell_at(window_point);
  finish(IMAGERY(textureLod(tiles_precise, slot_point(cell, window_point), 0.0)));
}
