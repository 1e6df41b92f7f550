// Antialiases the limb of a globe with light, and with AIR in air. A pixel on the limb has three parts: the ground's
// colour, the air beside the limb, and what shines through that air. The air may be thinner than a pixel, so its light
// is summed over the part of the pixel outside the limb (SkyColors of engine/sky/air_colors.h).
#if defined(AIR)
layout(binding = 2) uniform sampler2D limb_light;    // sums outwards from the limb, by azimuth and distance
layout(binding = 3) uniform sampler2D limb_through;
layout(binding = 7) uniform sampler2D ground_through;  // GroundColors
layout(binding = 8) uniform sampler2D ground_light;
layout(location = 2) uniform mat3 horizon_from_px;   // axes: x towards the Sun's azimuth, z up
// Distance of the limb, the height that a pixel of the tables covers, both in radii; steps of the tables in a pixel.
layout(location = 3) uniform vec3 limb;
#endif
const int kSlices = 2;                         // the pixel's square as strips along the limb
const float kSlice = 0.57735;                  // Gauss: twice the distance of a strip from the middle, in their range
const int kAside = 3;                          // pixels to each side along the limb that show a pixel's ground
#if defined(FROM_SAMPLES)
const float kInside_px = 0.9;                  // the square of a pixel this far inside or outside is on one side
#else
const float kInside_px = 0.22;                 // a pixel this far inside is ground, whatever the mesh's error
#endif

struct Air {
  float azimuth;
  float pixel;                                 // a pixel's height in units of the tables' pixel
};

#if defined(AIR)
Air air_here() {
  vec2 at = gl_FragCoord.xy - vec2(part_px.x, 0);
  vec3 ray = horizon_from_px * vec3(at, 1.0);
  vec3 step = horizon_from_px[0] * outward.x + horizon_from_px[1] * outward.y;
  vec3 across = cross(ray, step);
  return Air(atan(abs(ray.y), ray.x) / 3.14159265, limb.x * length(across) / dot(ray, ray) / limb.y);
}

// Sum of a table from the limb to a distance in pixels.
vec3 sum_to(sampler2D table, Air air, float distance_px) {
  vec2 size = vec2(textureSize(table, 0));
  vec2 at = vec2(air.azimuth * (size.x - 1.0), max(0.0, distance_px) * air.pixel * limb.z);
  return textureLod(table, (at + 0.5) / size, 0.0).rgb;
}

vec3 mean_over(sampler2D table, Air air, float from_px, float to_px) {
  return (sum_to(table, air, to_px) - sum_to(table, air, from_px)) / air.pixel;
}

// Air before the ground at a distance inside the limb: `through` and light, as in air.glsl. The cosine at which a ray
// meets the ground follows from the height of its lowest point, under the ground.
void ground_air(Air air, float inside_px, out vec3 through, out vec3 light) {
  float depth = max(0.0, inside_px) * air.pixel * limb.y;
  float down = sqrt(clamp(depth * (2.0 - depth), 0.0, 1.0));
  vec2 size = vec2(textureSize(ground_through, 0));
  vec2 at = (vec2(air.azimuth, sqrt(1.0 - sqrt(1.0 - down))) * (size - 1.0) + 0.5) / size;
  vec4 passed = textureLod(ground_through, at, 0.0), light_sq = textureLod(ground_light, at, 0.0);
  vec3 tint = vec3(passed.w, light_sq.w, 1.0 - passed.w - light_sq.w);
  through = passed.rgb * tint / max(tint.r, max(tint.g, tint.b));
  light = light_sq.rgb;
}

#endif

// Square of the ground's colour without air, of the pixel at a distance inside the limb.
vec3 ground_at(ivec2 off, float inside_px, Air air) {
  vec3 color = color_at(off), thin = vec3(1.0), thin_light = vec3(0.0);
#if defined(AIR)
  ground_air(air, inside_px, thin, thin_light);
#endif
  return clamp((color * color - thin_light) / max(thin, 0.02), 0.0, 2.0);
}

// Square of the ground's colour without air, next to the limb. A pixel there spans many degrees away from the limb and
// few along it. So pixels beside it along the limb show the same ground, and those count most that lie as near to the
// limb as the part of the pixel that shows ground. They see more ground than this part. Without air, what the pixel
// further inside sees is taken from their sum, so that ice thinner than a pixel keeps its light.
vec3 ground_near(ivec2 step, float apart, Air air) {
  ivec2 aside = step.x != 0 ? ivec2(0, rows_apart) : ivec2(1, 0);
  float wanted_px = max(max(kInside_px, 0.25 - 0.5 * outside_px), -outside_px);
  float part = clamp(0.5 - outside_px, 0.1, 1.0);
  vec4 sum = vec4(0.0);
  for (int k = -kAside; k <= kAside; ++k) {
    float there_px = outside_px + dot(vec2(k * aside), outward);
    int inwards = int(ceil(max(0.0, there_px + kInside_px) / apart));
    float inside_px = float(inwards) * apart - there_px, off = inside_px - wanted_px;
    ivec2 there = k * aside - inwards * step;
    vec3 ground = ground_at(there, inside_px, air);
#if !defined(AIR)
    float more = max(0.5 + min(inside_px, 0.5) - part, 0.0);
    ground += (ground - min(ground, ground_at(there - step, inside_px + apart, air))) * min(more / part, 2.0);
#endif
    float weight = 1.0 / (0.01 + off * off + 0.01 * float(k * k));
    sum += vec4(ground, 1.0) * weight * weight;
  }
  return min(sum.rgb / sum.w, vec3(1.0));
}

void main() {
  if (rows_apart == 0) {
    color_srgb = texelFetch(frame_srgb, ivec2(gl_FragCoord.xy), 0);
    return;
  }
  ivec2 step;
  float apart = step_px(step);
  vec2 sides = abs(outward);
  float width = max(sides.x, sides.y), range = max(min(sides.x, sides.y), 0.02);
#if defined(AIR)
  const float kClear_px = max(0.8, kInside_px);   // thick air differs from pixel to pixel, and a pixel outside the limb has only air
  Air air = air_here();
  vec3 light = vec3(0.0), through = vec3(0.0);
#elif defined(FROM_SAMPLES)
  const float kClear_px = kInside_px;
  Air air = Air(0.0, 1.0);
#else
  const float kClear_px = 0.1;
  Air air = Air(0.0, 1.0);
#endif
  int outwards = int(ceil(max(0.0, kClear_px - outside_px) / apart));
  vec3 beyond = color_at(outwards * step), ground_sq = ground_near(step, apart, air);
  float covered = covered_part(outside_px, width, range);
#if defined(AIR)
  float parts = 0.0, depths = 0.0;
  // A number of turns that the compiler does not know keeps the loop a loop: unrolled, it takes long to compile.
  int slices = (rows_apart + 1) & kSlices;
  for (int k = 0; k < slices; ++k) {
    float from_px = outside_px + (float(k) - 0.5) * kSlice * range - 0.5 * width;
    float part = clamp(-from_px / width, 0.0, 1.0);
    parts += part;
    depths += part * (-from_px - 0.5 * part * width);
    light += mean_over(limb_light, air, from_px, from_px + width) / width;
    through += mean_over(limb_through, air, from_px, from_px + width) / width;
  }
  vec3 thick, thick_light;
  ground_air(air, depths / max(parts, 1e-3), thick, thick_light);
  vec3 ground = sqrt(max(vec3(0.0), ground_sq * thick + thick_light));
  float d = outside_px + float(outwards) * apart;
  vec3 own = mean_over(limb_light, air, d - 0.5, d + 0.5), passed = mean_over(limb_through, air, d - 0.5, d + 0.5);
  vec3 background = clamp((beyond - own) / max(passed, 0.01), 0.0, 1.0);
  // The strips give the mean of the air. Its part of the pixel is known exactly.
  float part_of_strips = max(1.0 - parts / float(kSlices), 0.01);
  vec3 air_srgb = (light + background * through) / (float(kSlices) * part_of_strips);
  color_srgb = vec4(mix(air_srgb, ground, covered), 1.0);
#else
  color_srgb = vec4(mix(beyond, sqrt(ground_sq), covered), 1.0);
#endif
}
