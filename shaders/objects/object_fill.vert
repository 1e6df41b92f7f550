// Areas: triangles on the ground, lit like the ground, and slightly farther than their outlines.
layout(location = 0) in vec3 position_high_ecef;
layout(location = 1) in vec3 position_low_ecef;
layout(location = 2) in vec4 color;

out vec4 fill_color;
out vec3 air_through;
out vec3 air_light;
flat out float pull;

void main() {
  pull = 1.00005 - depth_bias;
  float day = smoothstep(-0.35, 0.5, dot(normalize(position_high_ecef), sun_ecef.xyz));
  fill_color = vec4(color.rgb * mix(1.0, mix(0.4, 1.0, day), sun_ecef.w), color.a);
  if (in_air()) air_before(from_eye(position_high_ecef, position_low_ecef), air_through, air_light);
  gl_Position = color.a == 0.0 ? kNowhere : clip_of(view_of(position_high_ecef, position_low_ecef), pull);
}
