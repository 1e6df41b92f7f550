// One piece of a line per instance: a box around all heights of the ground under it. The inputs are those of
// object_line.vert.
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
layout(location = 3) uniform vec2 ground_range;  // lowest and highest ground, metres
layout(location = 4) uniform float polar_scale;  // square of the equatorial over the polar radius

flat out mat3 ecef_from_view;
flat out vec3 here;                          // from the eye
flat out vec3 next;
flat out vec3 across;                        // unit normal of the line's vertical plane
flat out vec3 begins;                        // normals of the planes between the piece and its neighbours
flat out vec3 ends;
flat out float half_width_px;
flat out vec4 line_color;

const float kAround_px = 2.0;                // the box reaches this far around what is drawn

vec3 up_at(vec3 place_ecef) { return normalize(place_ecef * vec3(1.0, 1.0, polar_scale)); }

// Two neighbours compute the same plane, to the bit.
vec3 between(vec3 p, vec3 q, vec3 r) {
  vec3 to = q - p, from = r - q;
  float to_length = length(to), from_length = length(from);
  if (to_length == 0.0) return from / from_length;
  if (from_length == 0.0) return to / to_length;
  precise vec3 sum = to / to_length + from / from_length;
  return dot(sum, sum) > 1e-4 ? sum : from / from_length;
}

void main() {
  ecef_from_view = inverse(mat3(view_from_ecef));
  vec3 before = from_eye(before_high_ecef, before_low_ecef), after = from_eye(after_high_ecef, after_low_ecef);
  here = from_eye(here_high_ecef, here_low_ecef);
  next = from_eye(next_high_ecef, next_low_ecef);
  half_width_px = 0.5 * width;
  line_color = color;
  across = begins = ends = vec3(0.0);
  gl_Position = kNowhere;
  float metres = length(next - here);
  if (width <= 0.0 || color.a == 0.0 || metres == 0.0) return;
  vec3 way = (next - here) / metres;
  across = normalize(cross(way, up_at(here_high_ecef + next_high_ecef)));
  begins = between(before, here, next);
  ends = between(here, next, after);
  bool at_next = (0x287a >> gl_VertexID & 1) != 0;
  float side = (0x02af >> gl_VertexID & 1) != 0 ? -1.0 : 1.0, over = (0x31e3 >> gl_VertexID & 1) != 0 ? 1.0 : -1.0;
  vec3 up = up_at(at_next ? next_high_ecef : here_high_ecef), foot = at_next ? next : here;
  float sag = metres * metres / (4.0 * length(here_high_ecef));
  vec3 middle = foot + (over > 0.0 ? ground_range.y + sag : ground_range.x - sag) * up;
  float around = (half_width_px + kAround_px) * length(middle) / focal_px();
  vec3 position = middle + around * (side * across + over * up + (at_next ? way : -way));
  vec3 seen = mat3(view_from_ecef) * position;
  gl_Position = vec4(seen.xy * clip_scale.xy, -0.5 * seen.z, -seen.z);
}
