// The air before an object, by its distance and height.
layout(binding = 7) uniform sampler2D ground_through;    // GroundColors of engine/sky/air_colors.h
layout(binding = 8) uniform sampler2D ground_light;

// Objects under the ground have no air of their own: the surface drawn over them has air.
bool in_air() { return horizon_from_ecef[3].z > 0.0 && depth_bias > 0.0; }

void air_before(vec3 position_from_eye, out vec3 through, out vec3 light) {
  vec3 way = mat3(horizon_from_ecef) * position_from_eye, place = way + vec3(0.0, 0.0, horizon_from_ecef[3].z);
  float down = clamp(-dot(way, place) / max(length(way) * length(place), 1.0), 0.0, 1.0);
  vec2 at = air_place(way, down, vec2(textureSize(ground_through, 0)));
  vec3 to_ground = max(textureLod(ground_through, at, 0.0).rgb, 1e-6);
  float part = air_part(way, down, 1.0);
  through = pow(to_ground, vec3(part));
  light = air_light_of(textureLod(ground_light, at, 0.0).rgb, to_ground, part);
}

vec3 seen_through(vec3 lit_srgb, vec3 through, vec3 light) { return sqrt(lit_srgb * lit_srgb * through + light); }
