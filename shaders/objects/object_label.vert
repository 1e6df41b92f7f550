// One character of a text per instance: a square of the atlas beside the text's place, on whole pixels.
layout(location = 0) in vec3 place_high_ecef;
layout(location = 1) in vec3 place_low_ecef;
layout(location = 2) in vec2 offset_px;      // offset of the lower left corner
layout(location = 3) in vec4 atlas_px;       // upper left corner, width and height
layout(location = 4) in vec4 color;
layout(location = 5) in vec2 depth_reach;    // share of the place's depth at which the text lies; its reach, pixels
layout(location = 6) in vec2 ink_halo;       // factors of ink and halo

out vec2 texel;
flat out vec4 text_color;
flat out vec2 shares;
flat out float pull;

void main() {
  text_color = color;
  shares = ink_halo;
  // Labels are pulled towards the eye like markers, for the height of a text.
  pull = depth_reach.x * (1.0 - (depth_bias > 0.0 ? depth_bias + min(depth_reach.y / focal_px(), 0.5) : 0.0));
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  texel = atlas_px.xy + vec2(corner.x, 1.0 - corner.y) * atlas_px.zw;
  vec4 clip = clip_of(view_of(place_high_ecef, place_low_ecef), pull);
  if (clip.w > 0.0) {
    vec2 at_px = floor((clip.xy / clip.w * 0.5 + 0.5) * viewport_px + 0.5);
    clip.xy = ((at_px + offset_px + corner * atlas_px.zw) / viewport_px * 2.0 - 1.0) * clip.w;
  }
  gl_Position = clip;
}
