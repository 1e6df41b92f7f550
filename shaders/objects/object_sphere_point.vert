// One small sphere per point: a square around its outline, which is an ellipse in the picture.
flat out mat2 disc_from_px;
// Distance in front of the eye's plane: per unit of the disc's axes, and at its centre.
flat out vec3 disc_w;
flat out float size_px;
flat out vec3 air_through;
flat out vec3 air_light;

// Change of the pixel position along the disc's axis, at its centre.
vec2 px_of(vec3 axis_view, vec3 center_view) {
  float w = -center_view.z;
  return 0.5 * viewport_px * clip_scale.xy * (axis_view.xy * w + center_view.xy * axis_view.z) / (w * w);
}

void main() {
  Outline outline;
  disc_from_px = mat2(0.0);
  disc_w = vec3(0.0);
  size_px = 1.0;
  gl_PointSize = 1.0;
  if (!see_sphere(outline)) return;
  if (in_air()) air_before(outline.center, air_through, air_light);
  mat3 view = mat3(view_from_ecef);
  vec3 center = view * outline.center, side = view * outline.side, up = view * outline.up;
  mat2 px_from_disc = mat2(px_of(side, center), px_of(up, center));
  disc_from_px = inverse(px_from_disc);
  disc_w = vec3(-side.z, -up.z, -center.z);
  vec2 half_px = sqrt(px_from_disc[0] * px_from_disc[0] + px_from_disc[1] * px_from_disc[1]);
  size_px = 2.0 * (max(half_px.x, half_px.y) * (1.0 + kEdge_px / shape.y));
  gl_PointSize = size_px;
  gl_Position = flat_clip(center);
}
