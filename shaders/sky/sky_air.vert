// The air beside the globe as a mesh around the eye's vertical: one strip (instance) per pair of rows of heights over
// the horizon, with columns all the way round. Each vertex looks up its light in the frame's table
// (engine/sky/atmosphere.h). Fragments do little work, because there may be a million.
layout(binding = 0) uniform sampler2DArray sky_table;      // gas, dust, transmitted
layout(location = 0) uniform mat3 ecef_from_horizon;       // x towards the Sun's azimuth, z up
// The Sun in those axes; distance of the eye in the planet's radii.
layout(location = 1) uniform vec4 sun_and_radius;
// 1 if the eye is outside the air; height of the air in radii; dip; strips.
layout(location = 2) uniform vec4 rows;
layout(location = 3) uniform vec4 look;                    // exposure; g and its square; columns
out vec3 light_srgb;
out vec3 through_srgb;

const float kPi = 3.14159265;

// Sine and cosine of the angle from the zenith. The row before the first lies behind the globe, so that no gap appears
// beside it.
vec2 from_zenith(float row) {
  if (rows.x > 0.5) {
    float height = row < 0.0 ? -0.004 : row * row * rows.y;
    float sine = min(1.0, (1.0 + height) / sun_and_radius.w);
    return vec2(sine, -sqrt(1.0 - sine * sine));
  }
  float elevation = row < 0.0 ? -rows.z - 0.05 : row * row * (0.5 * kPi + rows.z) - rows.z;
  return vec2(cos(elevation), sin(elevation));
}

vec3 table_at(float azimuth, float row, float layer) {
  vec2 size = vec2(textureSize(sky_table, 0).xy);
  return textureLod(sky_table, vec3((vec2(azimuth, row) * (size - 1.0) + 0.5) / size, layer), 0.0).rgb;
}

float gas_phase(float c) { return 0.0596831 * (1.0 + c * c); }

float dust_phase(float c) {
  float d = 1.0 + look.z - 2.0 * look.y * c;
  return 0.1193662 * (1.0 - look.z) * (1.0 + c * c) / ((2.0 + look.z) * d * sqrt(d));
}

void main() {
  float row = float(gl_InstanceID + (gl_VertexID & 1) - 1) / (rows.w - 1.0);
  float turn = 2.0 * float(gl_VertexID >> 1) / look.w - 1.0;   // -1...1, in half turns from the Sun's azimuth
  vec2 zenith = from_zenith(row);
  vec3 ray = vec3(zenith.x * cos(kPi * turn), zenith.x * sin(kPi * turn), zenith.y);
  float table_row = max(0.0, row);
  if (rows.x > 0.5) table_row *= table_row;
  float c = dot(ray, sun_and_radius.xyz);
  vec3 light = table_at(abs(turn), table_row, 0.0) * gas_phase(c) + table_at(abs(turn), table_row, 1.0) * dust_phase(c);
  light_srgb = encoded_srgb(1.0 - exp(-look.x * light));
  through_srgb = pow(table_at(abs(turn), table_row, 2.0), vec3(1.0 / 2.2));
  vec3 p = mat3(view_from_ecef) * (ecef_from_horizon * ray);
  gl_Position = vec4(p.xy * clip_scale.xy, -0.5 * p.z, -p.z);
}
