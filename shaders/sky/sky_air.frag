// The air's light. The second output is the part of the background that shines through.
in vec3 light_srgb;
in vec3 through_srgb;
layout(location = 0, index = 0) out vec4 color_srgb;
layout(location = 0, index = 1) out vec4 transmitted_srgb;

void main() {
  color_srgb = vec4(light_srgb + dither(), 0.0);
  transmitted_srgb = vec4(through_srgb, 1.0);
}
