// A sphere around the planet's centre, relative to the eye.
layout(location = 0) in vec3 direction;
layout(location = 0) uniform float radius_m;

void main() {
  vec3 position_from_eye = (radius_m * direction - eye_high_ecef.xyz) - eye_low_ecef.xyz;
  vec3 position_view = mat3(view_from_ecef) * position_from_eye;
  float w = -position_view.z;
#if defined(DEPTH_REVERSED)
  gl_Position = vec4(position_view.xy * clip_scale.xy, clip_scale.z, w);
#else
  gl_Position = vec4(position_view.xy * clip_scale.xy, (w - clip_scale.z) * (clip_scale.w / (clip_scale.w - clip_scale.z)), w);
#endif
}
