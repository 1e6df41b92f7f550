// Extruded areas: triangles of walls and roofs.
layout(location = 0) in vec3 position_high_ecef;
layout(location = 1) in vec3 position_low_ecef;
layout(location = 2) in vec3 normal;
layout(location = 3) in vec4 color;

out vec3 normal_ecef;
out vec3 way_ecef;                           // from the eye to the vertex
out vec3 air_through;
out vec3 air_light;
flat out vec4 solid_color;
flat out float pull;

void main() {
  way_ecef = from_eye(position_high_ecef, position_low_ecef);
  normal_ecef = normal;
  solid_color = color;
  if (in_air()) air_before(way_ecef, air_through, air_light);
  pull = 1.0 - depth_bias;
  gl_Position = color.a == 0.0 ? kNowhere : clip_of(mat3(view_from_ecef) * way_ecef, pull);
}
