// A ribbon along the limb.
layout(location = 0) in vec2 position_ndc;
layout(location = 1) in vec2 outward_px;
layout(location = 2) in float distance_px;
out vec2 outward;
out float outside_px;

void main() {
  gl_Position = vec4(position_ndc, 0.5, 1.0);
  outward = outward_px;
  outside_px = distance_px;
}
