// The air beside the globe, looked up in the frame's table (engine/scene/atmosphere.h). What lies behind shines through by
// the second output.
layout(binding = 0) uniform sampler2DArray sky_table;      // gas, dust, transmitted
layout(location = 1) uniform vec4 up_and_radius;           // of the eye, over the body made a sphere; in its radii
layout(location = 2) uniform vec4 sun_and_stretch;         // the Sun over that sphere; z of a ray there over its z here
layout(location = 3) uniform vec4 rows;                    // 1: outside; reciprocal height of the air; dip; reciprocal span of angles
layout(location = 4) uniform vec3 exposure_and_dust;       // exposure; g and its square
in vec3 ray_ecef;
layout(location = 0, index = 0) out vec4 color_srgb;
layout(location = 0, index = 1) out vec4 transmitted_srgb;

// Row of the table for a ray at a sine and cosine from the zenith; more than 1 where there is no air.
float row_of(float cosine, float sine) {
  if (rows.x > 0.5) return cosine > 0.0 ? 2.0 : max(0.0, (up_and_radius.w * sine - 1.0) * rows.y);
  return sqrt(clamp((asin(clamp(cosine, -1.0, 1.0)) + rows.z) * rows.w, 0.0, 1.0));
}

float gas_phase(float c) { return 0.0596831 * (1.0 + c * c); }

float dust_phase(float c) {
  float g = exposure_and_dust.y, g2 = exposure_and_dust.z;
  float d = 1.0 + g2 - 2.0 * g * c;
  return 0.1193662 * (1.0 - g2) * (1.0 + c * c) / ((2.0 + g2) * d * sqrt(d));
}

void main() {
  vec3 ray = normalize(vec3(ray_ecef.xy, ray_ecef.z * sun_and_stretch.w));
  vec3 up = up_and_radius.xyz, sun = sun_and_stretch.xyz;
  float cosine = dot(ray, up);
  vec3 across = cross(ray, up);
  float sine = length(across);
  float row = row_of(cosine, sine);
  if (row > 1.0) discard;
  vec3 sun_across = cross(sun, up);
  float azimuth = acos(clamp(dot(across, sun_across) / max(sine * length(sun_across), 1e-9), -1.0, 1.0)) * 0.31830989;
  vec2 size = vec2(textureSize(sky_table, 0).xy);
  vec2 at = (vec2(azimuth, row) * (size - 1.0) + 0.5) / size;
  float c = dot(ray, sun);
  vec3 light = textureLod(sky_table, vec3(at, 0.0), 0.0).rgb * gas_phase(c) +
               textureLod(sky_table, vec3(at, 1.0), 0.0).rgb * dust_phase(c);
  color_srgb = vec4(encoded_srgb(1.0 - exp(-exposure_and_dust.x * light)), 0.0);
  transmitted_srgb = vec4(pow(textureLod(sky_table, vec3(at, 2.0), 0.0).rgb, vec3(1.0 / 2.2)), 1.0);
}
