// The whole picture, with the line of sight of each pixel.
layout(location = 0) uniform mat3 ecef_from_ndc;
out vec3 ray_ecef;

void main() {
  vec2 ndc = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1);
  ray_ecef = ecef_from_ndc * vec3(ndc, 1.0);
  gl_Position = vec4(ndc, 0.5, 1.0);
}
