// The air's light. The second output is the part of the background that shines through.
#if defined(THIN_RING)
layout(binding = 0) uniform sampler2D sky_light;
layout(binding = 1) uniform sampler2D sky_rows;
in vec2 place;
#else
in vec3 light_srgb;
in vec3 through_srgb;
#endif
layout(location = 0, index = 0) out vec4 color_srgb;
layout(location = 0, index = 1) out vec4 transmitted_srgb;

void main() {
#if defined(THIN_RING)
  vec2 size = vec2(textureSize(sky_light, 0));
  vec3 light_srgb = textureLod(sky_light, (place + 0.5) / size, 0.0).rgb;
  vec3 through_srgb = textureLod(sky_rows, vec2(0.25, (place.y + 0.5) / size.y), 0.0).rgb;
#endif
  color_srgb = vec4(light_srgb + dither(), 0.0);
  transmitted_srgb = vec4(through_srgb, 1.0);
}
