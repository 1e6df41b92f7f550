layout(binding = 0) uniform sampler2D atlas; // red: ink, green: halo
in vec2 texel;
flat in vec4 text_color;
flat in vec2 shares;                         // 1, 0 for ink; 0 and the strength for a halo
flat in float pull;
layout(location = 0) out vec4 color_srgb;

void main() {
  vec2 part = texelFetch(atlas, ivec2(texel), 0).rg;
  // Under its own ink, a halo only adds what the ink lacks of the halo's strength.
  float halo = max(shares.y * part.g - part.r, 0.0) / max(1.0 - part.r, 0.001);
  float alpha = shares.x * part.r + halo;
  if (alpha <= 0.0) discard;
  color_srgb = vec4(text_color.rgb, text_color.a * alpha);
  WRITE_DEPTH(pull);
}
