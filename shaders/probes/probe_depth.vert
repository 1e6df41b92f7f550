// A surface that leans over the whole picture: what the depth check tells from another.
layout(location = 0) uniform float distance_m;   // in the picture's middle

void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
  float w = distance_m * (1.0 + 0.25 * corner.y);
  gl_Position = vec4(corner * w, vertex_depth(w), w);
}
