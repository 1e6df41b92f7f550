// A sphere around the planet's centre, relative to the eye.
layout(location = 0) in vec3 direction;
layout(location = 0) uniform float radius_m;

void main() {
  vec3 position_from_eye = (radius_m * direction - eye_high_ecef.xyz) - eye_low_ecef.xyz;
  vec3 position_view = mat3(view_from_ecef) * position_from_eye;
  float w = -position_view.z;
  gl_Position = vec4(position_view.xy * clip_scale.xy, vertex_depth(w), w);
}
