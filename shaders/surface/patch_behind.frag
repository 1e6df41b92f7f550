// A copy of the picture behind a translucent surface, to blend over that surface.
layout(binding = 11) uniform sampler2D picture_behind;
layout(location = 0) out vec4 color_srgb;

void main() {
  color_srgb = vec4(texelFetch(picture_behind, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
  WRITE_DEPTH(1.0);
}
