// One sphere an instance: a triangle around its outline as the eye sees it, a circle in the plane where the cone of sight
// touches the sphere. Earth-fixed axes, not the view's: those of an off-axis picture are not at right angles.
layout(location = 0) in vec3 center_high_ecef;
layout(location = 1) in vec3 center_low_ecef;
layout(location = 2) in float radius;        // metres
layout(location = 3) in vec4 color;

out vec2 disc;                               // in that plane; the outline's radius is 1
flat out vec2 shape;                         // radius over distance; the outline's radius in pixels
flat out vec3 sun_disc;                      // in the disc's axes, z to the eye
flat out vec4 sphere_color;

const float kSmallest_px = 0.75;             // a smaller one is drawn as if it had this radius

void main() {
  vec3 c = from_eye(center_high_ecef, center_low_ecef);
  float away = length(c);
  float r = max(radius, kSmallest_px * away / focal_px());
  float q = r / away;
  float k2 = 1.0 - q * q;
  sphere_color = color;
  if (!(k2 > 0.0) || is_hidden(c, away, r)) {  // the eye is inside, or cannot see it
    disc = vec2(0.0);
    shape = vec2(0.0);
    sun_disc = vec3(0.0);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  vec3 axis = c / away;
  vec3 side = normalize(abs(axis.x) < 0.7 ? vec3(0.0, axis.z, -axis.y) : vec3(-axis.z, 0.0, axis.x));
  vec3 up = cross(axis, side);
  float k = sqrt(k2);
  shape = vec2(q, focal_px() * q / k);
  sun_disc = vec3(dot(sun_ecef.xyz, side), dot(sun_ecef.xyz, up), -dot(sun_ecef.xyz, axis));
  disc = corner_of(gl_VertexID) * (1.0 + 0.6 / shape.y);   // half a pixel of coverage
  vec3 position_view = mat3(view_from_ecef) * (c * k2 + (side * disc.x + up * disc.y) * (r * k));
  float w = -position_view.z;
  gl_Position = vec4(position_view.xy * clip_scale.xy, 0.5 * w, w);   // never cut at near and far: the fragment says its depth
}
