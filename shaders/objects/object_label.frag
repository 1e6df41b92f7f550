layout(binding = 0) uniform sampler2D atlas; // red: ink, green: halo
in vec2 texel;
flat in vec4 text_color;
flat in vec4 halo_color;                     // colour and strength
flat in float pull;
layout(location = 0) out vec4 color_srgb;

void main() {
  vec2 part = texelFetch(atlas, ivec2(texel), 0).rg;
  float alpha = max(part.r, halo_color.a * part.g);
  if (alpha <= 0.0) discard;
  color_srgb = vec4(mix(halo_color.rgb, text_color.rgb, part.r / alpha), text_color.a * alpha);
  WRITE_DEPTH(pull);
}
