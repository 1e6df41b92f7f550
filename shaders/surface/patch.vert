// A patch's vertex relative to the eye, and its point in the patch's tile window.
layout(location = 0) in vec3 position_high_ecef;
layout(location = 1) in vec3 position_low_ecef;
layout(location = 2) in vec3 direction;
layout(location = 3) in vec2 offset_deg;
layout(location = 4) in vec4 patch_center_and_scale;
layout(location = 5) in vec4 patch_frame;
layout(location = 6) in vec4 patch_row;
layout(location = 7) in uvec4 patch_window;
#if defined(RELIEF)
layout(location = 8) in vec2 slope;  // slope of the ground: rise per metre towards east and north
#endif

invariant gl_Position;
out vec2 window_point;
out vec3 row_direction;
out float light;
flat out uvec4 window;
flat out vec4 center_and_scale;
flat out vec4 frame;
flat out vec4 row;
#if defined(AIR)
layout(binding = 7) uniform sampler2D ground_through;    // GroundColors of engine/sky/air_colors.h
layout(binding = 8) uniform sampler2D ground_light;
out vec3 air_through;                                     // both per metre of distance: air.glsl
out vec3 air_light;

void look_through_air(vec3 position_from_eye, vec3 normal_ecef) {
  mat3 to_horizon = mat3(horizon_from_ecef);
  vec3 way = to_horizon * position_from_eye;
  float away = max(length(way), 1e-3);
  vec3 ray = way / away;
  vec3 up = normalize(to_horizon * (normal_ecef * vec3(1.0, 1.0, horizon_from_ecef[3].x)));
  float over = -dot(ray, up), down = clamp(over, 0.0, 1.0);
  vec2 size = vec2(textureSize(ground_through, 0));
  vec2 at = vec2(atan(abs(ray.y), ray.x) / 3.14159265, sqrt(1.0 - sqrt(1.0 - down)));
  at = (at * (size - 1.0) + 0.5) / size;
  air_through = textureLod(ground_through, at, 0.0).rgb;
  air_light = textureLod(ground_light, at, 0.0).rgb;
  // Behind the horizon the air goes on, so that a triangle that crosses the horizon has the air of its near side.
  float metres = over < 0.0 ? min(away, 1.0 / horizon_from_ecef[3].y) : away;
  air_through = (1.0 - air_through) / metres;
  air_light /= metres;
}
#endif

// Soft light from the sun's side. The night side keeps a quarter.
float light_of(vec3 normal_ecef) {
#if defined(NIGHT_LIGHTS)
  return dot(normal_ecef, sun_ecef.xyz);  // patch_common.glsl turns this into day and night
#endif
  float day = smoothstep(-0.35, 0.75, dot(normal_ecef, sun_ecef.xyz));
  return mix(1.0, mix(0.25, 1.0, day), sun_ecef.w);
}

void main() {
  // The high parts are subtracted first. Near the eye their difference is exact (Sterbenz), so the shared vertices of
  // two patches are equal.
  precise vec3 position_from_eye = (position_high_ecef - eye_high_ecef.xyz) + (position_low_ecef - eye_low_ecef.xyz);
  precise vec3 position_view = mat3(view_from_ecef) * position_from_eye;
  float w = -position_view.z;
  gl_Position = vec4(position_view.xy * clip_scale.xy, vertex_depth(w), w);
  window_point = patch_center_and_scale.xy + offset_deg * vec2(patch_center_and_scale.z, -patch_center_and_scale.w);
  row_direction = direction;
  vec3 center = vec3(patch_frame.xy * patch_frame.z, patch_frame.w);
  vec3 m = center + direction;
  vec3 normal = normalize(vec3(m.xy, m.z / texels.w));
  light = light_of(normal);
#if defined(AIR)
  look_through_air(position_from_eye, normal);
#endif
#if defined(RELIEF)
  vec3 east = normalize(vec3(-normal.y, normal.x + 1e-12, 0.0));
  vec3 ground = normalize(normal - slope.x * east - slope.y * cross(normal, east));
  // Slopes towards the sun are brighter than level ground in the same light, slopes away from it darker.
#if defined(NIGHT_LIGHTS)
  light += dot(ground, sun_ecef.xyz) - dot(normal, sun_ecef.xyz);
#else
  light *= clamp(1.0 + 1.3 * sun_ecef.w * (dot(ground, sun_ecef.xyz) - dot(normal, sun_ecef.xyz)), 0.3, 1.6);
#endif
#endif
  window = patch_window;
  center_and_scale = patch_center_and_scale;
  frame = patch_frame;
  row = patch_row;
}
