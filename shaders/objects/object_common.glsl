// Functions for all objects: positions relative to the eye, and depth a little nearer to the eye, so that objects on
// the ground do not sink into it.
layout(location = 0) uniform vec2 viewport_px;
layout(location = 1) uniform float depth_bias;   // fraction of the distance, ≥ 0
// Radius of a sphere around the planet's centre that hides the objects behind it; 0: none.
layout(location = 2) uniform float hiding_radius;

// Outside the picture: the place of hidden objects, whose alpha is 0.
const vec4 kNowhere = vec4(2.0, 2.0, 2.0, 1.0);

// Position relative to the eye, Earth-fixed axes.
vec3 from_eye(vec3 high_ecef, vec3 low_ecef) {
  precise vec3 p = (high_ecef - eye_high_ecef.xyz) + (low_ecef - eye_low_ecef.xyz);
  return p;
}

vec3 view_of(vec3 high_ecef, vec3 low_ecef) { return mat3(view_from_ecef) * from_eye(high_ecef, low_ecef); }

// Distance in front of the eye's plane.
float w_of(vec3 from_eye_ecef) {
  return -dot(vec3(view_from_ecef[0].z, view_from_ecef[1].z, view_from_ecef[2].z), from_eye_ecef);
}

// True if a whole ball lies in or behind the hiding sphere, which does not contain the eye. A ball lies behind if the
// line of sight to its centre passes the sphere's centre at less than the difference of their radii, before it ends.
bool is_hidden(vec3 center_from_eye, float away, float radius) {
  float within = 0.999 * hiding_radius - radius;
  float passes = -dot(eye_high_ecef.xyz, center_from_eye) / away;
  if (within > 0.0 && length(eye_high_ecef.xyz + center_from_eye) < within) return true;
  if (within <= 0.0 || passes <= 0.0 || passes >= away) return false;
  return dot(eye_high_ecef.xyz, eye_high_ecef.xyz) - passes * passes < within * within;
}

// Pixels per metre at a distance of one metre.
float focal_px() { return 0.5 * viewport_px.y * clip_scale.y; }

// Clip position with the depth of a point `pull` times as far.
vec4 clip_of(vec3 position_view, float pull) {
  float w = -position_view.z;
  return vec4(position_view.xy * clip_scale.xy, vertex_depth(w * pull) / pull, w);
}

// Light on a side that faces the eye: like spheres, darker at a slant, and a little brighter on the sun's side.
float light_on(vec3 normal_ecef, vec3 to_eye) {
  float sunny = mix(0.8, 1.08, smoothstep(-0.5, 0.8, dot(normal_ecef, sun_ecef.xyz)));
  return mix(1.0, mix(0.5, 1.0, dot(normal_ecef, to_eye)) * sunny, sun_ecef.w);
}

// A triangle around the unit circle, which needs half as many triangles as a square.
vec2 corner_of(int vertex) {
  const float s = 1.7320508;
  return vertex == 0 ? vec2(0.0, 2.0) : vertex == 1 ? vec2(-s, -1.0) : vec2(s, -1.0);
}
