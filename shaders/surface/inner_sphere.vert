// The shapes that hide the far side, relative to the eye: a sphere around the planet's centre, or positions already
// relative to the eye.
layout(location = 0) in vec3 place;
layout(location = 0) uniform vec2 scale;  // metres per unit; 1: relative to the planet's centre, 0: relative to the eye
out float facing;  // cosine between the sphere's normal and the direction to the eye; 0 beside the sphere

void main() {
  vec3 position_from_eye = (scale.x * place - scale.y * eye_high_ecef.xyz) - scale.y * eye_low_ecef.xyz;
  vec3 position_view = mat3(view_from_ecef) * position_from_eye;
  float w = -position_view.z;
  facing = scale.y * max(0.0, -dot(normalize(position_from_eye), place));
  gl_Position = vec4(position_view.xy * clip_scale.xy, vertex_depth(w), w);
}
