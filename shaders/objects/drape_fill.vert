// One triangle of an area per instance: a prism around all heights of the ground over the triangle, its sides vertical.
layout(location = 0) in vec3 a_high_ecef;
layout(location = 1) in vec3 a_low_ecef;
layout(location = 2) in vec3 b_high_ecef;
layout(location = 3) in vec3 b_low_ecef;
layout(location = 4) in vec3 c_high_ecef;
layout(location = 5) in vec3 c_low_ecef;
layout(location = 6) in vec4 color;
layout(location = 3) uniform vec2 ground_range;  // lowest and highest ground, metres
layout(location = 4) uniform float polar_scale;  // square of the equatorial over the polar radius

flat out mat3 ecef_from_view;
// Vertical planes through the sides: a normal, and its product with the places of the plane.
flat out vec4 plane_ab;
flat out vec4 plane_bc;
flat out vec4 plane_ca;
flat out vec3 inside;                        // 1 or -1: the side of each plane on which the triangle lies
flat out vec4 fill_color;

const int kCorners[24] = int[24](0, 2, 1, 3, 4, 5, 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 2, 0, 3, 2, 3, 5);
const float kAround_px = 1.0;                // the prism reaches further than the triangle
const float kRounding = 1.0e-6;              // error of a plane's distance, relative to that of its places

vec3 up_at(vec3 place_ecef) { return normalize(place_ecef * vec3(1.0, 1.0, polar_scale)); }

bool is_before(vec3 p, vec3 q) { return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z; }

// Triangles that share a side compute the same plane, to the bit.
vec4 plane_of(vec3 p, vec3 q, vec3 p_ecef, vec3 q_ecef) {
  if (!is_before(p_ecef, q_ecef)) {
    vec3 kept = p;
    p = q;
    q = kept;
  }
  precise vec3 normal = normalize(cross(q - p, up_at(p_ecef + q_ecef)));
  precise float far = dot(normal, p);
  return vec4(normal, far);
}

void main() {
  ecef_from_view = inverse(mat3(view_from_ecef));
  vec3 place[3] = vec3[3](a_high_ecef, b_high_ecef, c_high_ecef);
  vec3 at[3] = vec3[3](from_eye(a_high_ecef, a_low_ecef), from_eye(b_high_ecef, b_low_ecef), from_eye(c_high_ecef, c_low_ecef));
  plane_ab = plane_of(at[0], at[1], place[0], place[1]);
  plane_bc = plane_of(at[1], at[2], place[1], place[2]);
  plane_ca = plane_of(at[2], at[0], place[2], place[0]);
  inside = vec3(dot(plane_ab.xyz, at[2]) >= plane_ab.w ? 1.0 : -1.0, dot(plane_bc.xyz, at[0]) >= plane_bc.w ? 1.0 : -1.0,
                dot(plane_ca.xyz, at[1]) >= plane_ca.w ? 1.0 : -1.0);
  fill_color = color;
  gl_Position = kNowhere;
  if (color.a == 0.0) return;
  vec3 across = cross(at[1] - at[0], at[2] - at[0]);
  float longest = max(length(at[1] - at[0]), max(length(at[2] - at[1]), length(at[0] - at[2])));
  float farthest = max(length(at[0]), max(length(at[1]), length(at[2])));
  // A needle that is thinner than the rounding of its planes has no inside.
  if (length(across) < kRounding * farthest * longest) return;
  bool clockwise = dot(across, place[0]) < 0.0;
  int corner = kCorners[gl_VertexID], k = corner % 3;
  if (clockwise) {
    corner = kCorners[gl_VertexID - gl_VertexID % 3 + 2 - gl_VertexID % 3];
    k = corner % 3;
  }
  // A flat triangle lies under the ellipsoid by at most the square of its longest side over six radii.
  float sag = longest * longest / (6.0 * length(place[0]));
  // Each side moves out by the same length.
  vec3 up = up_at(place[k]), to_next = at[(k + 1) % 3] - at[k], to_last = at[(k + 2) % 3] - at[k];
  float around = kAround_px * length(at[k]) / focal_px();
  vec3 out_next = normalize(cross(to_next, up)), out_last = normalize(cross(to_last, up));
  if (dot(out_next, to_last) > 0.0) out_next = -out_next;
  if (dot(out_last, to_next) > 0.0) out_last = -out_last;
  vec3 out_both = (out_next + out_last) / max(1.0 + dot(out_next, out_last), 0.05);
  float height = corner < 3 ? ground_range.x - sag : ground_range.y + sag;
  vec3 position = at[k] + around * out_both + (height + (corner < 3 ? -around : around)) * up;
  vec3 seen = mat3(view_from_ecef) * position;
  gl_Position = vec4(seen.xy * clip_scale.xy, -0.5 * seen.z, -seen.z);
}
