// Copies the depth of a picture whose lower left corner lies at `corner_px` of the framebuffer.
layout(binding = 0) uniform sampler2D picture_depth;
layout(location = 0) uniform ivec2 corner_px;

void main() { gl_FragDepth = texelFetch(picture_depth, ivec2(gl_FragCoord.xy) - corner_px, 0).r; }
