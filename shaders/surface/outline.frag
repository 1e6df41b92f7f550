// Antialiases the outline of ground that does not follow the limb's curve, such as mountains before the sky. A pixel on
// the outline gets a share of the colour beyond. The pixels around it show where the edge runs: the number of ground
// pixels gives its distance, and their sides give its direction.
layout(binding = 0) uniform sampler2D frame_srgb;
layout(binding = 1) uniform sampler2D frame_depth;
// 2: the rows between belong to the other eye; 0: frame_srgb contains the outline, with alpha 0 beside it.
layout(location = 0) uniform int rows_apart;
layout(location = 1) uniform ivec4 part_px;    // first and last column and row of this eye's picture
layout(location = 2) uniform float no_depth;   // depth of empty pixels
layout(location = 0) out vec4 color_srgb;

const int kReach = 2;                          // examined pixels to each side

ivec2 place(ivec2 off) { return clamp(ivec2(gl_FragCoord.xy) + off * ivec2(1, rows_apart), part_px.xy, part_px.zw); }
bool is_ground(ivec2 off) { return texelFetch(frame_depth, place(off), 0).r != no_depth; }
vec4 color_at(vec2 off) { return texelFetch(frame_srgb, place(ivec2(round(off))), 0); }

void main() {
  if (rows_apart == 0) {
    color_srgb = texelFetch(frame_srgb, ivec2(gl_FragCoord.xy), 0);
    if (color_srgb.a == 0.0) discard;
    return;
  }
  // An edge through or near this pixel separates the corners.
  bool low = is_ground(ivec2(-kReach)), high = is_ground(ivec2(kReach));
  bool same = low == high && low == is_ground(ivec2(-kReach, kReach)) && low == is_ground(ivec2(kReach, -kReach));
  int reach = same ? -1 : kReach;              // the loops then do not run
  float ground = 0.0;
  vec2 side = vec2(0.0);
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      float here = is_ground(ivec2(x, y)) ? 1.0 : 0.0;
      ground += here;
      side += here * vec2(x, y);
    }
  }
  if (side == vec2(0.0)) discard;
  vec2 outward = -normalize(side);
  // A straight edge at a distance d leaves half of the square, plus d times its width, as ground.
  float width = float(2 * kReach + 1);
  float outside_px = (0.5 - ground / (width * width)) * width * max(abs(outward.x), abs(outward.y));
  if (abs(outside_px) >= 1.0) discard;
  // The colour of the other side comes from beyond the edge, the colour of its own side from the pixel itself.
  bool inside = is_ground(ivec2(0));
  vec4 own = color_at(vec2(0.0)), other = color_at(outward * ((inside ? 1.25 : -1.25) - outside_px));
  float share = clamp(0.5 + (inside ? outside_px : -outside_px), 0.0, 1.0);
  color_srgb = vec4(mix(own, other, share).rgb, 1.0);
}
