// The ground under a pixel, from the depth of the picture. Lines and areas that lie on the ground colour the pixels whose
// ground lies in them. So they agree with the ground at every level of detail, and have no depth of their own.
#if defined(SAMPLES)
layout(binding = 0) uniform sampler2DMS ground_depth;
#define DEPTH_AT(px) texelFetch(ground_depth, px, gl_SampleID).r
#else
layout(binding = 0) uniform sampler2D ground_depth;
#define DEPTH_AT(px) texelFetch(ground_depth, px, 0).r
#endif
layout(location = 5) uniform ivec3 picture_at;   // lower left corner in the texture, pixels; rows of the same eye apart
layout(location = 0) out vec4 color_srgb;

// Distance in front of the eye's plane; 0: no ground. The inverse of window_depth().
float w_of_depth(float depth) {
#if defined(DEPTH_REVERSED)
  return depth > 0.0 ? clip_scale.z / depth : 0.0;
#elif defined(DEPTH_LOGARITHMIC)
  return depth < 1.0 ? (exp2(depth * log2(clip_scale.w / clip_scale.z + 1.0)) - 1.0) * clip_scale.z : 0.0;
#else
  return depth < 1.0 ? clip_scale.z / (1.0 - depth * ((clip_scale.w - clip_scale.z) / clip_scale.w)) : 0.0;
#endif
}

bool in_picture(ivec2 px) {
  return all(greaterThanEqual(px, picture_at.xy)) && all(lessThan(px, picture_at.xy + ivec2(viewport_px)));
}

// The ground `off` pixels away, from the eye, Earth-fixed axes; false if there is none.
bool ground_at(mat3 ecef_from_view, ivec2 off, out vec3 ground) {
  ivec2 px = ivec2(gl_FragCoord.xy) + off;
  ground = vec3(0.0);
  if (!in_picture(px)) return false;
  float w = w_of_depth(DEPTH_AT(px));
  if (w <= 0.0) return false;
  vec2 at = (gl_FragCoord.xy + vec2(off) - vec2(picture_at.xy)) / viewport_px;
  ground = ecef_from_view * (vec3((2.0 * at - 1.0) / clip_scale.xy, -1.0) * w);
  return true;
}
