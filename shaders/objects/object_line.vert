// One piece of a line per instance: four corners around the way from `here` to `next`, mitred with the pieces before
// and after. All four points come from one list of vertices, each input one vertex further on.
layout(location = 0) in vec3 before_high_ecef;
layout(location = 1) in vec3 before_low_ecef;
layout(location = 2) in vec3 here_high_ecef;
layout(location = 3) in vec3 here_low_ecef;
layout(location = 4) in vec3 next_high_ecef;
layout(location = 5) in vec3 next_low_ecef;
layout(location = 6) in vec3 after_high_ecef;
layout(location = 7) in vec3 after_low_ecef;
layout(location = 8) in float width;         // pixels; 0: no piece begins here
layout(location = 9) in vec4 color;
layout(location = 10) in vec2 length_along;  // metres: before the piece, and of the piece
layout(location = 11) in vec2 dashes;        // 1/8 px

// Pixels from the middle, times w, so that the value is linear on the screen.
out float across_w;
flat out float half_width_px;
flat out vec4 line_color;
out vec3 air_through;
out vec3 air_light;
flat out float pull;
out float along;
flat out vec2 dash_px;

const float kMostMitre = 2.0;                // factor of half the width

// Part of the way from p to q before it gets in front of the eye's plane, so that both ends have a place on the screen.
float part_behind(vec3 p, vec3 q) {
  float least = clip_scale.z;   // parts before the near plane are not drawn
  return -p.z >= least || q.z >= p.z ? 0.0 : clamp((-least - p.z) / (q.z - p.z), 0.0, 1.0);
}
vec3 before_eye(vec3 p, vec3 q) { return mix(p, q, part_behind(p, q)); }

vec2 screen_px(vec3 p) { return p.xy * clip_scale.xy / -p.z * 0.5 * viewport_px; }

vec2 unit_or(vec2 v, vec2 otherwise) {
  float l = length(v);
  return l > 1e-3 ? v / l : otherwise;
}

// Factor of p's distance at which the local horizontal level through p lies, `off` from p on the plane at distance 1.
// Across its width a line keeps its level. If it had the depth of its middle everywhere, ground that rises towards the
// eye would hide one half.
float flat_depth(vec3 p, vec2 off) {
  vec3 up = mat3(view_from_ecef) * eye_high_ecef.xyz + p;  // direction from the planet's centre
  vec3 ray = vec3(p.xy / -p.z + off, -1.0);
  float along = dot(up, ray);
  const float most = 1.05;  // limit for levels seen edge-on
  return along < 0.0 ? clamp(dot(up, p) / (-p.z * along), 1.0 / most, most) : 1.0;
}

void main() {
  vec3 here = view_of(here_high_ecef, here_low_ecef), next = view_of(next_high_ecef, next_low_ecef);
  half_width_px = 0.5 * relief.w * width;
  line_color = color;
  pull = 1.0 - depth_bias;
  dash_px = dashes / 8.0;
  along = 0.0;
  across_w = 0.0;
  gl_Position = kNowhere;
  float least = clip_scale.z;   // parts before the near plane are not drawn
  if (width <= 0.0 || color.a == 0.0 || (-here.z < least && -next.z < least)) return;
  bool at_b = gl_VertexID >= 2;
  if (in_air()) {
    vec3 end = at_b ? from_eye(next_high_ecef, next_low_ecef) : from_eye(here_high_ecef, here_low_ecef);
    air_before(end, air_through, air_light);
  }
  vec3 a = before_eye(here, next), b = before_eye(next, here);
  vec3 before = before_eye(view_of(before_high_ecef, before_low_ecef), here);
  vec3 after = before_eye(view_of(after_high_ecef, after_low_ecef), next);
  along = length_along.x + length_along.y * (at_b ? 1.0 - part_behind(next, here) : part_behind(here, next));
  vec2 a_px = screen_px(a), b_px = screen_px(b);
  vec2 way = unit_or(b_px - a_px, vec2(1.0, 0.0));
  vec2 other = at_b ? unit_or(screen_px(after) - b_px, way) : unit_or(a_px - screen_px(before), way);
  // An end that was moved to the eye's plane is not a real corner.
  if (at_b ? (-next.z < least || -after.z < least) : (-here.z < least || -before.z < least)) other = way;
  vec2 mitre = unit_or(way + other, way);
  float reach = min(1.0 / max(dot(mitre, way), 1e-3), kMostMitre);
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  float across_px = side * (half_width_px + 1.0);
  vec3 middle = at_b ? b : a;
  vec2 off = vec2(-mitre.y, mitre.x) * (across_px * reach) * (2.0 / viewport_px);
  vec4 clip = clip_of(middle * flat_depth(middle, off / clip_scale.xy), pull);
  clip.xy += off * clip.w;
  across_w = across_px * clip.w;
  gl_Position = clip;
}
