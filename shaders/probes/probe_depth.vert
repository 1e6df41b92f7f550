// An inclined surface over the whole picture. The depth test of the stability check compares it with others.
layout(location = 0) uniform float distance_m;   // at the picture's centre

void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
  float w = distance_m * (1.0 + 0.25 * corner.y);
  gl_Position = vec4(corner * w, vertex_depth(w), w);
}
