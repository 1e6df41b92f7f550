// `exact`: coordinates and derivatives for each fragment, everywhere; the GPU's anisotropic filter does the rest.
layout(binding = 2) uniform sampler2DArray tiles_anisotropic;

void main() {
  WindowPoint w = exact_window_point();
  vec4 cell = cell_at(w.p);
  finish(textureGrad(tiles_anisotropic, vec3(w.p * cell.x + cell.yz, cell.w), w.dx * cell.x, w.dy * cell.x).rgb);
}
