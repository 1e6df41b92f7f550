// Small spheres as they were drawn in memory: colour, multiplied by how much of the pixel it covers, and depth of the
// nearest one at each pixel.
noperspective in vec2 in_run_px;
flat in uint first_pixel;
layout(binding = 0) uniform usamplerBuffer pixels;
layout(location = 0) out vec4 color_srgb;

const uvec2 kBlock_px = uvec2(64, 32);
const uint kPixels = kBlock_px.x * kBlock_px.y;   // of a block: their colours, then their nearness

void main() {
  uvec2 at = uvec2(in_run_px), block_at = uvec2(at.x % kBlock_px.x, at.y);
  int k = int(first_pixel + at.x / kBlock_px.x * 2 * kPixels + block_at.y * kBlock_px.x + block_at.x);
  float nearness = uintBitsToFloat(texelFetch(pixels, k + int(kPixels)).r);
  if (nearness == 0.0) discard;
  vec4 straight = unpackUnorm4x8(texelFetch(pixels, k).r);
  color_srgb = vec4(straight.rgb * straight.a, straight.a);
  gl_FragDepth = window_depth_of_nearness(nearness);
}
