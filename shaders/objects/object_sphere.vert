// One sphere per instance: a triangle around its outline.
out vec2 disc;                               // in the outline's plane; its radius is 1
out vec3 way_ecef;                           // from the eye to that place

void main() {
  Outline outline;
  disc = vec2(0.0);
  way_ecef = vec3(0.0);
  if (!see_sphere(outline)) return;
  disc = corner_of(gl_VertexID) * (1.0 + kEdge_px / shape.y);
  way_ecef = outline.center + outline.side * disc.x + outline.up * disc.y;
  gl_Position = flat_clip(mat3(view_from_ecef) * way_ecef);
}
