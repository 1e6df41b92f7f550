// A vertex of a model; one place of the model per instance.
layout(location = 0) in vec3 position_model; // metres
layout(location = 1) in vec3 normal_model;
layout(location = 2) in vec2 uv_in;
layout(location = 3) in vec4 color_in;       // linear
layout(location = 4) in vec3 place_high_ecef;
layout(location = 5) in vec3 place_low_ecef;
layout(location = 6) in vec3 left_ecef;      // the model's x, y and z axes at its place
layout(location = 7) in vec3 up_ecef;
layout(location = 8) in vec3 forward_ecef;
layout(location = 9) in vec4 tint_in;        // mixed in by its alpha

out vec3 normal_ecef;
out vec3 way_ecef;                           // from the eye to the vertex
out vec2 uv;
out vec4 color_linear;
out vec3 air_through;
out vec3 air_light;
flat out vec4 tint;
flat out float pull;

void main() {
  mat3 ecef_from_model = mat3(left_ecef, up_ecef, forward_ecef);
  way_ecef = from_eye(place_high_ecef, place_low_ecef) + ecef_from_model * position_model;
  normal_ecef = ecef_from_model * normal_model;
  uv = uv_in;
  tint = tint_in;
  color_linear = color_in;
  if (in_air()) air_before(way_ecef, air_through, air_light);
  pull = 1.0 - depth_bias;
  gl_Position = clip_of(mat3(view_from_ecef) * way_ecef, pull);
}
