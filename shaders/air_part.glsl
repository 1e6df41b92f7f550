// The air before a thing, as a share of the air before the ground under the same angle: by the distance and by the mean
// density on the way. As in GroundColors (engine/sky/air_colors.h), 1.2 times the air straight between the eye's height
// and the thing's does not count.
const float kAirScale_m = 7000.0;   // scale height of gas and dust together
const float kMostScales = 5.0;      // there is no air to speak of over this many
const float kPicturedAirMass = 1.2;
const float kLeastCounted = 0.02;   // share of the way in the air

float mean_density(float above, float over) {
  float apart = over - above;
  return abs(apart) < 1e-3 ? exp(-above) : (exp(-above) - exp(-over)) / apart;
}

// Under the ellipsoid is water, which has no air: seen from this height or more, nothing there has more air than the
// ellipsoid. Land lies only a few hundred metres under it, and is near such an eye.
const float kOverWater_m = 1000.0;

// `way`: from the eye, in the axes of the horizon; `down`: cosine between the way and the vertical at its end. The
// height at its end is divided by `exaggeration`.
float air_part(vec3 way, float down, float exaggeration) {
  float eye = horizon_from_ecef[3].z, eye_height = horizon_from_ecef[3].w, radius = eye - eye_height;
  float above = max(0.0, length(way + vec3(0.0, 0.0, eye)) - radius) / (kAirScale_m * exaggeration);
  float height = clamp(eye_height, 1.0, kMostScales * kAirScale_m), over = height / kAirScale_m;
  float steep = radius * down, horizon = 1.0 / horizon_from_ecef[3].y, in_air = sqrt(height * (2.0 * radius + height));
  float ground_m = horizon * horizon / (steep + length(vec2(steep, horizon)));
  float ground_in_air = in_air * in_air / (steep + length(vec2(steep, in_air)));
  float away = length(way) - max(0.0, ground_m - ground_in_air);
  // Both have the same least share, so that on the ellipsoid the result is 1 straight down too.
  float counts = max(away - kPicturedAirMass * kAirScale_m * abs(over - above), kLeastCounted * away);
  float to_ground = max(ground_in_air - kPicturedAirMass * height, kLeastCounted * ground_in_air);
  float most = above > 0.0 ? counts : max(1.0, kOverWater_m / max(eye_height, 1.0)) * to_ground;
  return min(counts, most) / to_ground * mean_density(above, over) / mean_density(0.0, over);
}

// Place of a ray in the tables of GroundColors.
vec2 air_place(vec3 way, float down, vec2 size) {
  return (vec2(atan(abs(way.y), way.x) / 3.14159265, sqrt(1.0 - sqrt(1.0 - down))) * (size - 1.0) + 0.5) / size;
}

// Light adds up as on film. `light_sq` came with the part `from` of the background, and comes with `from` to the power
// of `part`. Where the air takes next to nothing, its light grows as `part` does.
vec3 air_light_of(vec3 light_sq, vec3 from, float part) {
  vec3 lost = 1.0 - from, share = mix(vec3(part), (1.0 - pow(from, vec3(part))) / lost, greaterThan(abs(lost), vec3(1e-3)));
  return 1.0 - pow(1.0 - clamp(light_sq, 0.0, 0.9999), share);
}
