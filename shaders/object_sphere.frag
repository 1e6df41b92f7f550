in vec3 ray_ecef;
flat in vec4 sphere_ecef;
flat in vec4 sphere_color;
layout(location = 0) out vec4 color_srgb;

void main() {
  vec3 ray = normalize(ray_ecef);
  vec3 c = sphere_ecef.xyz;
  float r = sphere_ecef.w;
  float along = dot(ray, c);
  vec3 off = c - ray * along;
  float d2 = dot(off, off);
  float coverage = clamp(0.5 + (r - sqrt(d2)) * focal_px() / along, 0.0, 1.0);
  if (coverage <= 0.0) discard;
  vec3 hit = ray * (along - sqrt(max(r * r - d2, 0.0)));
  vec3 normal = (hit - c) / r;
  // Round to the eye, and a little brighter where the sun is.
  float light = mix(0.5, 1.0, clamp(-dot(normal, ray), 0.0, 1.0)) * mix(0.8, 1.08, smoothstep(-0.5, 0.8, dot(normal, sun_ecef.xyz)));
  color_srgb = vec4(sphere_color.rgb * mix(1.0, light, sun_ecef.w), sphere_color.a * coverage);
  gl_FragDepth = window_depth(w_of(hit));
}
