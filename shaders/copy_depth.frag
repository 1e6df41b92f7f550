// Copies the depth of a picture whose lower left corner lies at `corner_px` of the framebuffer. With SAMPLES both have as
// many samples.
#if defined(SAMPLES)
layout(binding = 0) uniform sampler2DMS picture_depth;
#else
layout(binding = 0) uniform sampler2D picture_depth;
#endif
layout(location = 0) uniform ivec2 corner_px;

void main() {
#if defined(SAMPLES)
  int from = gl_SampleID;
#else
  const int from = 0;
#endif
  gl_FragDepth = texelFetch(picture_depth, ivec2(gl_FragCoord.xy) - corner_px, from).r;
}
