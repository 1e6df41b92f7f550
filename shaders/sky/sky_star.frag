in vec3 peak_linear;
flat in float inverse_variance;
flat in float point_px;
layout(location = 0) out vec4 color_srgb;

void main() {
  vec2 d = (gl_PointCoord - 0.5) * point_px;
  color_srgb = vec4(encoded_srgb(peak_linear * exp(-0.5 * dot(d, d) * inverse_variance)), 0.0);
}
