// A sphere as the eye sees it. Its outline is a circle in the plane where the cone of sight touches the sphere. Axes
// are Earth-fixed, because the view's axes are not at right angles in an off-axis picture.
layout(location = 0) in vec3 center_high_ecef;
layout(location = 1) in vec3 center_low_ecef;
layout(location = 2) in float radius;        // metres
layout(location = 3) in vec4 color;

flat out vec2 shape;                         // radius over distance; the outline's radius in pixels
flat out vec3 sun_disc;                      // in the disc's axes, z towards the eye
flat out vec4 sphere_color;

const float kSmallest_px = 0.75;             // a smaller sphere is drawn as if it had this radius
const float kEdge_px = 0.6;                  // coverage extends this far outside the outline

struct Outline {
  vec3 center, side, up;                     // from the eye, metres; the disc's axes have the length of its radius
};

// False if the eye is inside the sphere or cannot see it.
bool see_sphere(out Outline outline) {
  vec3 c = from_eye(center_high_ecef, center_low_ecef);
  float away = length(c);
  float r = max(radius, relief.w * kSmallest_px * away / focal_px());
  float q = r / away;
  float k2 = 1.0 - q * q;
  sphere_color = color;
  shape = vec2(0.0);
  sun_disc = vec3(0.0);
  gl_Position = kNowhere;
  if (color.a == 0.0 || !(k2 > 0.0) || is_hidden(c, away, r)) return false;
  vec3 axis = c / away;
  vec3 side = normalize(abs(axis.x) < 0.7 ? vec3(0.0, axis.z, -axis.y) : vec3(-axis.z, 0.0, axis.x));
  vec3 up = cross(axis, side);
  float k = sqrt(k2);
  shape = vec2(q, focal_px() * q / k);
  sun_disc = vec3(dot(sun_ecef.xyz, side), dot(sun_ecef.xyz, up), -dot(sun_ecef.xyz, axis));
  outline = Outline(c * k2, side * (r * k), up * (r * k));
  return true;
}

// Never clipped at near and far: the fragment writes its own depth.
vec4 flat_clip(vec3 position_view) {
  float w = -position_view.z;
  return vec4(position_view.xy * clip_scale.xy, 0.5 * w, w);
}
