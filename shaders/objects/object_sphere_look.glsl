// The colour and depth of a sphere's pixel.
flat in vec2 shape;
flat in vec3 sun_disc;
flat in vec4 sphere_color;
layout(location = 0) out vec4 color_srgb;

// `disc` is the position in the outline's plane; `w` is its distance in front of the eye's plane. Returns the factor
// from there to the sphere.
float draw_sphere(vec2 disc, float w) {
  float d2 = dot(disc, disc);
  float coverage = clamp(0.5 + (1.0 - sqrt(d2)) * shape.y, 0.0, 1.0);
  if (coverage <= 0.0) discard;
  float bulge = sqrt(max(1.0 - d2, 0.0));
  // Shading towards the rim, and a little brighter on the sun's side.
  float light = mix(0.5, 1.0, bulge) * mix(0.8, 1.08, smoothstep(-0.5, 0.8, dot(vec3(disc, bulge), sun_disc)));
  color_srgb = vec4(sphere_color.rgb * mix(1.0, light, sun_ecef.w), sphere_color.a * coverage);
  // The ray to the point p of the disc's plane meets the sphere at t p: |t p - c| = r, solved for t relative to p.
  float q = shape.x;
  float t = (1.0 - q * bulge) / (1.0 - q * q * (1.0 - min(d2, 1.0)));
  gl_FragDepth = window_depth(t * w);
  return t;
}
