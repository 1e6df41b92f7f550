// One icon per instance: a picture of constant size on the screen, at the depth of its place.
// The lowest part of the layer's icons under their places. All are pulled alike, so the nearer is over the farther.
layout(location = 4) uniform float below_px;
layout(binding = 1) uniform usampler2D places;  // each icon in the atlas: left, top, width, height, texels
layout(location = 0) in vec3 place_high_ecef;
layout(location = 1) in vec3 place_low_ecef;
layout(location = 2) in vec4 up;                // the upper edge: Earth-fixed, or on the screen if w is 1
layout(location = 3) in vec2 anchor;            // part of the sides that lies at the place, from the upper left
layout(location = 4) in float size;             // longer side, pixels
layout(location = 5) in uint image;
layout(location = 6) in vec4 color;
layout(location = 7) in vec4 wash_color;

out vec2 at_px;                                 // from the upper left corner, along the sides
flat out vec2 sides_px;
flat out vec4 place;
flat out float texels_of_pixel;
flat out vec4 tint;
flat out vec4 wash;
flat out float pull;

// Direction of the upper edge on the screen, y up. A level direction is seen as the way that its place would go.
vec2 up_on_screen(vec3 c) {
  if (up.w == 1.0) return up.xy;
  vec3 d = mat3(view_from_ecef) * up.xyz;
  vec2 way = (c.xy * d.z - d.xy * c.z) * clip_scale.xy * viewport_px;
  return dot(way, way) > 0.0 ? normalize(way) : vec2(0.0, 1.0);
}

void main() {
  vec3 center = from_eye(place_high_ecef, place_low_ecef);
  vec3 c = mat3(view_from_ecef) * center;
  place = vec4(texelFetch(places, ivec2(int(image), 0), 0));
  texels_of_pixel = max(place.z, place.w) / (relief.w * size);
  sides_px = place.zw / texels_of_pixel;
  tint = color;
  wash = wash_color;
  at_px = mix(vec2(-1.0), sides_px + 1.0, vec2(gl_VertexID & 1, gl_VertexID >> 1));  // edges are a pixel wide
  vec2 high = up_on_screen(c), right = vec2(high.y, -high.x);
  vec2 from_place = at_px - anchor * sides_px;
  vec2 offset_px = from_place.x * right - from_place.y * high;
  // The ground under the part below the place is nearer to the eye, as under a marker.
  pull = 1.0 - (depth_bias > 0.0 ? depth_bias + min(4.0 * relief.w * below_px / focal_px(), 0.5) : 0.0);
  vec4 clip = clip_of(c, pull);
  if (clip.w > 0.0) clip.xy += offset_px * (2.0 / viewport_px) * clip.w;
  gl_Position = color.a == 0.0 || is_hidden(center, length(center), 0.0) ? kNowhere : clip;
}
