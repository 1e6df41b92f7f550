// A square around the Sun or Moon, perpendicular to the line of sight, at infinity.
layout(location = 0) uniform vec3 center_ecef;    // unit
layout(location = 1) uniform vec3 side_ecef[2];   // half the square's width, at distance 1
out vec2 on_disc;                                 // -1...1
out vec3 direction_ecef;

void main() {
  on_disc = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
  direction_ecef = center_ecef + side_ecef[0] * on_disc.x + side_ecef[1] * on_disc.y;
  vec3 p = mat3(view_from_ecef) * direction_ecef;
  gl_Position = vec4(p.xy * clip_scale.xy, -0.5 * p.z, -p.z);
}
