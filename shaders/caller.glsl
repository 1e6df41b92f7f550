// Functions for shaders of an application that draws into a globe's frame (Globe::on_draw()). All names begin with
// terrella_. The block is the beginning of the frame's own (frame.glsl).
layout(std140, binding = 0) uniform terrella_Frame {
  mat4 terrella_view_from_ecef;  // rotation only
  vec4 terrella_eye_high_m;      // ECEF; high and low floats of the double position
  vec4 terrella_eye_low_m;
  vec4 terrella_clip_scale;      // x, y: focal lengths; z: near plane, metres; w: far plane, metres
};

// Offset from the eye, ECEF axes, metres, of a place whose double coordinates are split into two floats: the nearest
// float, and the rest.
vec3 terrella_from_eye(vec3 high_m, vec3 low_m) {
  precise vec3 offset = (high_m - terrella_eye_high_m.xyz) + (low_m - terrella_eye_low_m.xyz);
  return offset;
}

// gl_Position of a place at this offset.
vec4 terrella_clip(vec3 from_eye_m) {
  vec3 view = mat3(terrella_view_from_ecef) * from_eye_m;
  float w = -view.z, near = terrella_clip_scale.z, far = terrella_clip_scale.w;
#if defined(DEPTH_REVERSED)
  return vec4(view.xy * terrella_clip_scale.xy, near, w);
#else
  return vec4(view.xy * terrella_clip_scale.xy, (w - near) * (far / (far - near)), w);
#endif
}

// Statement for main() of every fragment shader that writes depth.
#if defined(DEPTH_LOGARITHMIC)
#define TERRELLA_WRITE_DEPTH \
  gl_FragDepth = log2(1.0 / gl_FragCoord.w / terrella_clip_scale.z + 1.0) / \
                 log2(terrella_clip_scale.w / terrella_clip_scale.z + 1.0)
#else
#define TERRELLA_WRITE_DEPTH
#endif
