// Copies the samples of a picture whose lower left corner lies at `corner_px` of the framebuffer.
layout(binding = 0) uniform sampler2DMS picture_srgb;
layout(location = 0) uniform ivec2 corner_px;
layout(location = 0) out vec4 color_srgb;

void main() { color_srgb = texelFetch(picture_srgb, ivec2(gl_FragCoord.xy) - corner_px, gl_SampleID); }
