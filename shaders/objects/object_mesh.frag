// Lit like spheres; both sides of a triangle are drawn.
layout(binding = 0) uniform sampler2D base;
layout(location = 3) uniform vec4 part_color_linear;
layout(location = 4) uniform vec2 alpha;     // smaller alpha is not drawn; 1: blended
in vec3 normal_ecef;
in vec3 way_ecef;
in vec2 uv;
in vec4 color_linear;
in vec3 air_through;
in vec3 air_light;
flat in vec4 tint;
flat in float pull;
layout(location = 0) out vec4 color_srgb;

vec3 srgb_of(vec3 linear) {
  return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), linear));
}

void main() {
  vec3 flat_normal = cross(dFdx(way_ecef), dFdy(way_ecef));
  vec4 color = part_color_linear * color_linear * texture(base, uv);
  if (color.a < alpha.x) discard;
  vec3 to_eye = -normalize(way_ecef);
  vec3 normal = normalize(dot(normal_ecef, normal_ecef) > 0.0 ? normal_ecef : flat_normal);
  if (dot(normal, to_eye) < 0.0) normal = -normal;
  vec3 srgb = mix(srgb_of(clamp(color.rgb, 0.0, 1.0)), tint.rgb, tint.a);
  color_srgb = vec4(srgb * light_on(normal, to_eye), mix(1.0, color.a, alpha.y));
  if (in_air()) color_srgb.rgb = seen_through(color_srgb.rgb, air_through, air_light);
  WRITE_DEPTH(pull);
}
