layout(location = 1) uniform vec3 inner_srgb;
in float facing;
layout(location = 0) out vec4 color_srgb;

// A little darker towards its rim, so that the sphere looks round. Black stays black.
void main() {
  color_srgb = vec4(inner_srgb * mix(0.35, 1.0, facing), 1.0);
  WRITE_DEPTH(1.0);
}
