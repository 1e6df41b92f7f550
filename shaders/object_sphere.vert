// One sphere an instance: a triangle that covers the sphere's outline as the eye sees it. The fragment casts its own ray.
// Earth-fixed axes, not the view's: those of an off-axis picture are not at right angles.
layout(location = 0) in vec3 center_high_ecef;
layout(location = 1) in vec3 center_low_ecef;
layout(location = 2) in float radius;        // metres
layout(location = 3) in vec4 color;

out vec3 ray_ecef;                           // to the triangle's point, from the eye
flat out vec4 sphere_ecef;                   // centre from the eye, radius
flat out vec4 sphere_color;

const float kSmallest_px = 0.75;             // a smaller one is drawn as if it had this radius

void main() {
  vec3 c = from_eye(center_high_ecef, center_low_ecef);
  float away = length(c);
  float focal = focal_px();
  float r = max(radius, kSmallest_px * away / focal);
  sphere_ecef = vec4(c, r);
  sphere_color = color;
  float k2 = 1.0 - (r * r) / (away * away);
  if (!(k2 > 0.0)) {                         // the eye is inside
    ray_ecef = vec3(0.0);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  // The outline is a circle in the plane where the cone of sight touches the sphere.
  vec3 axis = c / away;
  vec3 side = normalize(cross(axis, abs(axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  vec2 corner = corner_of(gl_VertexID) * (r * sqrt(k2) + 1.5 * away / focal);
  ray_ecef = c * k2 + side * corner.x + cross(axis, side) * corner.y;
  vec3 position_view = mat3(view_from_ecef) * ray_ecef;
  float w = -position_view.z;
  gl_Position = vec4(position_view.xy * clip_scale.xy, 0.5 * w, w);   // never cut at near and far: the fragment says its depth
}
