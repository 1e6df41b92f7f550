// The air beside the globe as a mesh around the eye's vertical: one strip (instance) per pair of rows of heights over
// the horizon, with columns all the way round. The colours are those of SkyColors (engine/sky/air_colors.h). Fragments
// do little work, because there may be a million. With THIN_RING the air is a few pixels high: there is one strip, and
// fragments look the colours up.
layout(binding = 0) uniform sampler2D sky_light;           // stored colours, by azimuth and row
layout(binding = 1) uniform sampler2D sky_rows;            // per row: part of the background; sine, cosine from the zenith
layout(location = 0) uniform mat3 ecef_from_horizon;       // x towards the Sun's azimuth, z up
layout(location = 1) uniform float steps;                  // steps of the mesh, all the way round
#if defined(THIN_RING)
out vec2 place;                                            // in the tables: column and row, from 0
#else
out vec3 light_srgb;
out vec3 through_srgb;
#endif

const float kPi = 3.14159265;

void main() {
#if defined(THIN_RING)
  int row = (gl_VertexID & 1) * (textureSize(sky_rows, 0).y - 1);
#else
  int row = gl_InstanceID + (gl_VertexID & 1);
#endif
  // -1...1, in half turns from the Sun's azimuth.
  float turn = 2.0 * fract(float(gl_VertexID >> 1) / steps) - 1.0;
  vec2 zenith = texelFetch(sky_rows, ivec2(1, row), 0).xy;
  vec3 ray = vec3(zenith.x * cos(kPi * turn), zenith.x * sin(kPi * turn), zenith.y);
  vec2 size = vec2(textureSize(sky_light, 0));
#if defined(THIN_RING)
  place = vec2(abs(turn) * (size.x - 1.0), row);
#else
  light_srgb = textureLod(sky_light, (vec2(abs(turn) * (size.x - 1.0), row) + 0.5) / size, 0.0).rgb;
  through_srgb = texelFetch(sky_rows, ivec2(0, row), 0).rgb;
#endif
  vec3 p = mat3(view_from_ecef) * (ecef_from_horizon * ray);
  gl_Position = vec4(p.xy * clip_scale.xy, -0.5 * p.z, -p.z);
}
