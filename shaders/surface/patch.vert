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
layout(location = 8) in vec2 height_offset_deg;  // as offset_deg, in the rows of the heights' grid
layout(location = 9) in vec4 slope_center_and_scale;
layout(location = 10) in uvec4 patch_slope_window;
out vec2 slope_point;
#if defined(AT_POLE)
flat out vec2 slope_column;  // column of the patch's centre; columns per degree
#else
out vec3 light_enu;  // direction of the light on relief: east, north, up
#endif
flat out uvec4 slope_window;
const vec3 kFromNorthWest = vec3(-0.5, 0.5, 0.70710678);
#endif

// The windows of further layers of a stack. Without slopes there is room for a fourth layer.
#if defined(STACK)
layout(location = 11) in vec4 scale_1;
layout(location = 12) in uvec4 patch_window_1;
layout(location = 13) in vec4 scale_2;
layout(location = 14) in uvec4 patch_window_2;
out vec2 window_point_1, window_point_2, window_point_3;
flat out uvec4 window_1, window_2, window_3;
flat out vec4 center_and_scale_1, center_and_scale_2, center_and_scale_3;
#if STACK > 3
layout(location = 9) in vec4 scale_3;
layout(location = 10) in uvec4 patch_window_3;
#endif
#endif

// The point of the patch, 0 to 1 along its sides, for the pictures of what lies on it.
#if defined(ON_GROUND)
layout(location = 15) in uvec4 patch_ground;
layout(location = 20) uniform int points_a_side;
out vec2 ground_point;
out float object_light;
flat out uvec4 ground_window;
#endif

#if defined(SPECIAL_LAYER)
out float shadow_of_layer;
#endif
#if defined(SPECIAL_LAYER) || defined(AT_LIMB)
out float towards_eye;   // cosine between the normal and the eye
#endif
#if defined(GLINT)
out vec4 glint;      // slope of the water that mirrors the Sun, ECEF; light of a mirror as rough as the sea
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
out vec3 air_through;                                     // with NEAR_GROUND, the part that is lost per metre of air_metres()
out vec3 air_light;

#if defined(NEAR_GROUND)
out vec3 air_tint;
#endif
#if defined(DAY_AND_NIGHT)
out vec3 sun_tint;
#endif

void look_through_air(vec3 position_from_eye, vec3 normal_ecef) {
  mat3 to_horizon = mat3(horizon_from_ecef);
  vec3 way = to_horizon * position_from_eye;
  float away = max(length(way), 1e-3);
  vec3 up = normalize(to_horizon * (normal_ecef * vec3(1.0, 1.0, horizon_from_ecef[3].x)));
  float over = -dot(way, up) / away, down = clamp(over, 0.0, 1.0);
  vec2 at = air_place(way, down, vec2(textureSize(ground_through, 0)));
  vec4 through = textureLod(ground_through, at, 0.0), light_sq = textureLod(ground_light, at, 0.0);
  vec3 tint = vec3(through.w, light_sq.w, 1.0 - through.w - light_sq.w);
  tint /= max(tint.r, max(tint.g, tint.b));
  // Sunlight is red where the Sun is low. What shines by itself keeps its colour.
#if defined(DAY_AND_NIGHT)
  sun_tint = sqrt(tint);
  tint = vec3(1.0);
#elif defined(GROUND_ALONE)
  tint = vec3(1.0);
#elif defined(SPECIAL_LAYER)
  if (layer_look.x < 0.0) tint = vec3(1.0);
#endif
  air_through = through.rgb;
  air_light = light_sq.rgb;
  // Ground over the ellipsoid has less air before it, and so has a layer at a height. Exaggerated mountains have the air
  // of their real heights.
#if defined(RELIEF)
  float exaggeration = max(relief.x, 1.0);
#elif defined(SPECIAL_LAYER)
  const float exaggeration = 1.0;
  if (surface_look.x > 0.0)
#endif
#if defined(RELIEF) || defined(SPECIAL_LAYER)
  {
    vec3 to_ground = max(air_through, 1e-6);
    float part = air_part(way, down, exaggeration);
    air_through = pow(to_ground, vec3(part));
    air_light = air_light_of(air_light, to_ground, part);
  }
#endif
#if defined(NEAR_GROUND)
  // Behind the horizon the air goes on, so that a triangle that crosses the horizon has the air of its near side.
  float metres = air_metres(over < 0.0 ? min(away, 1.0 / horizon_from_ecef[3].y) : away);
  air_through = (1.0 - air_through) / metres;
  air_light /= metres;
  air_tint = tint;
#else
  air_through *= tint;
#endif
}
#endif

// Soft light from the Sun's side; the night side keeps a quarter. Without a time the Sun is a lamp whose light is full
// from 30 degrees on: imagery is pictured by such a Sun.
float light_of(vec3 normal_ecef) {
#if defined(DAY_AND_NIGHT)
  return dot(normal_ecef, sun_ecef.xyz);  // patch_common.glsl turns this into day and night
#endif
  float sun_sine = dot(normal_ecef, sun_ecef.xyz);
  float day = surface_look.w > 0.0 ? daylight(sun_sine) : smoothstep(-0.35, 0.5, sun_sine);
  return mix(1.0, mix(0.25, 1.0, day), sun_ecef.w);
}

#if defined(REGOLITH)
// Dust shines towards the Sun. surface_look.y is the light of the night side.
float dust_light(vec3 normal_ecef, vec3 eye_ecef) {
  float day = regolith_light(normal_ecef, sun_ecef.xyz, eye_ecef);
  return mix(1.0, mix(surface_look.y, 1.0, day), sun_ecef.w);
}
#endif

// East, north and up.
vec3 in_enu(vec3 normal, vec3 v) {
  vec3 east = normalize(vec3(-normal.y, normal.x + 1e-12, 0.0));
  return vec3(dot(east, v), dot(cross(normal, east), v), dot(normal, v));
}

#if defined(GLINT)
// C. Cox, W. Munk, "Measurement of the roughness of the sea surface", 1954, without the share of the slopes, which is
// the fragment's; the mirror's light by Schlick's formula for water.
vec4 sea_glint(vec3 normal, vec3 eye) {
  vec3 half_way = normalize(eye + sun_ecef.xyz);
  float middle = dot(normal, half_way), up = max(middle, 0.05), seen = max(dot(eye, normal), 0.05);
  float mirror = 0.02 + 0.98 * pow(1.0 - max(dot(eye, half_way), 0.0), 5.0);
  // The Sun's own light, without that of the sky: the air overhead has an optical depth of a quarter.
  float sunlight = exp(0.25 - 0.25 / max(dot(normal, sun_ecef.xyz), 0.02));
  return vec4((half_way - middle * normal) / up, sunlight * mirror / (4.0 * seen * pow(up, 4.0)));
}
#endif

#if defined(AT_LIMB)
// Height of the ground at the limb, metres (frame.glsl). All triangles of the limb lie clearly before those of the whole
// patches, so that depth tells them apart: layers over the ground have each pixel once.
float raised_m(float cosine) {
  float part = max(0.0, 1.0 - cosine * cosine / limb.y);
  return max(part * part, 0.05) * limb.x;
}
#endif

void main() {
  // The high parts are subtracted first. Near the eye their difference is exact (Sterbenz), so the shared vertices of
  // two patches are equal.
  precise vec3 position_from_eye = (position_high_ecef - eye_high_ecef.xyz) + (position_low_ecef - eye_low_ecef.xyz);
  vec3 center = vec3(patch_frame.xy * patch_frame.z, patch_frame.w);
  vec3 m = center + direction;
  vec3 normal = normalize(vec3(m.xy, m.z / texels.w));
#if defined(SPECIAL_LAYER)
  position_from_eye += max(surface_look.x, 0.0) * normal;
#endif
#if defined(SPECIAL_LAYER) || defined(AT_LIMB)
  towards_eye = -dot(normalize(position_from_eye), normal);
#endif
#if defined(AT_LIMB)
  position_from_eye += raised_m(towards_eye) * normal;
#endif
  precise vec3 position_view = mat3(view_from_ecef) * position_from_eye;
  float w = -position_view.z;
  gl_Position = vec4(position_view.xy * clip_scale.xy, vertex_depth(w), w);
  window_point = patch_center_and_scale.xy + offset_deg * vec2(patch_center_and_scale.z, -patch_center_and_scale.w);
#if defined(STACK)
  window_point_1 = scale_1.xy + offset_deg * vec2(scale_1.z, -scale_1.w);
  window_point_2 = scale_2.xy + offset_deg * vec2(scale_2.z, -scale_2.w);
  window_1 = patch_window_1;
  window_2 = patch_window_2;
  center_and_scale_1 = scale_1;
  center_and_scale_2 = scale_2;
#if STACK > 3
  window_point_3 = scale_3.xy + offset_deg * vec2(scale_3.z, -scale_3.w);
  window_3 = patch_window_3;
  center_and_scale_3 = scale_3;
#endif
#endif
  row_direction = direction;
#if defined(ON_GROUND)
  int point = gl_VertexID % (points_a_side * points_a_side);
  ground_point = vec2(point % points_a_side, point / points_a_side) / float(points_a_side - 1);
  object_light = mix(1.0, mix(0.4, 1.0, smoothstep(-0.35, 0.5, dot(normal, sun_ecef.xyz))), sun_ecef.w);
  ground_window = patch_ground;
#endif
#if defined(SPECIAL_LAYER)
  // The shadow that the layer towards the Sun throws on the ground. surface_look.x is then the layer's height in radii,
  // less than 0.
  vec3 sun_enu = in_enu(normal, sun_ecef.xyz);
  shadow_of_layer = 0.5 * sun_ecef.w * smoothstep(0.0, 0.2, sun_enu.z);
  // The ray to the Sun meets the layer, on a sphere, after `way` radii. Under three degrees, where shadows are
  // faint, they grow no longer (kLongestShadow of engine/surface/plan/tile_coverage.h).
  float up = max(sun_enu.z, 0.05), height = -min(surface_look.x, 0.0);
  float way = sqrt(up * up + height * (2.0 + height)) - up;
  vec2 towards_sun = way / (1.0 + way * up) * sun_enu.xy;
  towards_sun.x /= max(length(normal.xy), 0.01);
  window_point += degrees(towards_sun) * vec2(patch_center_and_scale.z, -patch_center_and_scale.w);
#endif
#if defined(AIR)
  look_through_air(position_from_eye, normal);
#endif
#if defined(REGOLITH)
  light = dust_light(normal, -normalize(position_from_eye));
#else
  light = light_of(normal);
#endif
#if defined(GLINT)
  glint = sea_glint(normal, -normalize(position_from_eye));
#endif
#if defined(RELIEF)
#if defined(AT_POLE)
  slope_column = slope_center_and_scale.xz;
#else
  light_enu = relief.y > 0.0 ? kFromNorthWest : in_enu(normal, sun_ecef.xyz);
#endif
  slope_point = slope_center_and_scale.xy + height_offset_deg * vec2(slope_center_and_scale.z, -slope_center_and_scale.w);
  slope_window = patch_slope_window;
#endif
  window = patch_window;
  center_and_scale = patch_center_and_scale;
  frame = patch_frame;
  row = patch_row;
}
