// Small spheres as they were drawn in memory: colour and depth of the nearest one at each pixel.
in vec2 in_block_px;
flat in int first_pixel;
layout(binding = 0) uniform usamplerBuffer pixels;
layout(location = 0) out vec4 color_srgb;

const int kBlock_px = 32;

void main() {
  ivec2 at = ivec2(in_block_px);
  int k = first_pixel + at.y * kBlock_px + at.x;
  uint rgba = texelFetch(pixels, k).r;
  if (rgba == 0u) discard;
  color_srgb = unpackUnorm4x8(rgba);
  gl_FragDepth = window_depth(1.0 / uintBitsToFloat(texelFetch(pixels, k + kBlock_px * kBlock_px).r));
}
