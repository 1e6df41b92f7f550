// Look-ups shared by all texturing methods of patches.
layout(binding = 1) uniform usamplerBuffer window_cells;    // slot | log2 rows << 16 | log2 columns << 24
const int kSlotMips = 4;  // mip levels of a slot; kMips of engine/globe/image_layer.cpp

in vec3 row_direction;
in float light;
#if defined(SPECIAL_LAYER) || defined(AT_LIMB)
in float towards_eye;
#endif
flat in vec4 frame;
flat in vec4 row;
layout(location = 0) out vec4 color_srgb;

// A cell: slot coordinates of a window point p are p * scale + offset.
struct Cell {
  vec2 scale;
  vec2 offset;
  float layer;
};

#if defined(SPECIAL_LAYER)
#define UPPER_LAYER
#endif

// The base layer is opaque. Upper layers are premultiplied by their alpha.
#if defined(UPPER_LAYER)
#define Imagery vec4
#define IMAGERY(texel) (texel)
#else
#define Imagery vec3
#define IMAGERY(texel) (texel).rgb
#endif

// Geodetic normal, of any length.
vec3 ground_normal() {
  return (vec3(frame.xy * frame.z, frame.w) + row_direction) * vec3(1.0, 1.0, 1.0 / texels.w);
}

// Longitude from the patch's centre. Row directions have the longitudes of their normals.
float east_of_center_deg() {
  vec2 d = row_direction.xy;
  return degrees(atan(frame.x * d.y - frame.y * d.x, frame.z + frame.x * d.x + frame.y * d.y));
}

#if defined(DAY_AND_NIGHT)
#if defined(AIR)
in vec3 sun_tint;    // colour of sunlight on the ground, a factor of stored colours
#else
const vec3 sun_tint = vec3(1.0);
#endif

// Day and night by the Sun's height. Here `light` is the sine of the Sun's height.
vec3 by_sunlight(vec3 imagery_srgb) {
  if (sun_ecef.w == 0.0) return imagery_srgb;
  return imagery_srgb * mix(vec3(0.06, 0.07, 0.11), vec3(1.0), daylight(light));
}

#if defined(CITY_LIGHTS)
layout(binding = 6) uniform samplerCube night_lights;

vec3 city_lights() {
  // A cube map needs no arc tangent, and has no seam and no pole.
  vec3 normal = ground_normal();
  vec3 dx = dFdx(normal), dy = dFdy(normal);
  float night = sun_ecef.w * lamplight(light);
  return textureGrad(night_lights, normal, dx, dy).r * night * vec3(1.0, 0.84, 0.54);
}
#else
vec3 city_lights() { return vec3(0.0); }
#endif
#endif

#if defined(GLINT) && !defined(UPPER_LAYER)
in vec4 glint;

// The sea is where the imagery is clearly more blue than red, by a factor of 1.2 to 1.7, and no less than green, by 0.85
// to 1.05. A steep change of the colour is a coast: it takes a pixel at least, or its edge would be jagged.
float sea_share(vec3 imagery_srgb) {
  vec3 c = imagery_srgb + 0.02;
  vec2 over = c.b - vec2(1.45, 0.95) * c.rg;
  vec2 width = max(vec2(0.25, 0.1) * c.rg, fwidth(over));
  vec2 share = smoothstep(-width, width, over);
  return share.x * share.y;
}

// Slopes of the sea in a wind of 5 m/s are normal with a variance of 0.029. White ground of a full Sun has the light 1.
// Squares stand for light, as in through_air(). Under a low Sun the sea shines many times as brightly as white ground:
// it comes near kBrightest slowly, for a mere limit would make one even patch of it, with an edge.
const float kBrightest = 1.5;
vec3 with_glint(vec3 color_srgb, vec3 imagery_srgb) {
  // The share counts after the limit: a fiftieth of the sea under a low Sun would shine as brightly as all of it.
  float mirrored = glint.w * exp(-dot(glint.xyz, glint.xyz) / 0.029) / 0.029;
  float light = mirrored / (1.0 + mirrored / kBrightest) * sea_share(imagery_srgb);
  return sqrt(color_srgb * color_srgb + light * vec3(1.0, 0.95, 0.85));
}
#else
#define with_glint(color_srgb, imagery_srgb) (color_srgb)
#endif

// `sea`: the sea in the imagery mirrors the Sun.
vec3 lit(vec3 imagery_srgb, float alpha, bool sea) {
#if defined(RELIEF)
  vec3 shaded_srgb = imagery_srgb * relief_light();
#else
  vec3 shaded_srgb = imagery_srgb;
#endif
#if defined(DAY_AND_NIGHT)
  vec3 day_srgb = by_sunlight(shaded_srgb);
  return (sea ? with_glint(day_srgb, imagery_srgb) : day_srgb) * sun_tint + city_lights() * alpha;
#else
  vec3 lit_srgb = shaded_srgb * light;
  return sea ? with_glint(lit_srgb, imagery_srgb) : lit_srgb;
#endif
}

#if defined(SPECIAL_LAYER)
in float shadow_of_layer;   // by day

#if defined(BLENDED_LAYER)
vec3 blended(vec3 imagery_srgb, float alpha);   // patch_blend.glsl
#endif
#endif

// Shown fraction of a layer by day or night; `side`: layer_look.x.
float part_shown(float side) {
  if (side == 0.0) return 1.0;
  float night = lamplight(dot(normalize(ground_normal()), sun_ecef.xyz));
  return side > 0.0 ? 1.0 - night : night;
}
// 1 on the side of the swipe's line that `line` says, else 0: layer_look.z.
float on_side(float line) {
  return line == 0.0 || (gl_FragCoord.x - axis_px.w < abs(line)) == (line > 0.0) ? 1.0 : 0.0;
}
// A premultiplied colour after layer_tone.
vec3 toned(vec3 imagery_srgb, float alpha, vec4 tone) {
  if (tone.w == 0.0) return imagery_srgb;
  vec3 color = imagery_srgb / max(alpha, 1e-3);
  return pow(clamp((color - 0.5) * tone.y + 0.5 + tone.x, 0.0, 1.0), vec3(tone.z)) * alpha;
}
float brightness(vec3 imagery_srgb) { return max(max(imagery_srgb.r, imagery_srgb.g), imagery_srgb.b); }

// The result equals blending all layers first and lighting the blend. Layers that show by night emit light and are not
// lit.
void finish(Imagery imagery_srgb) {
#if defined(UPPER_LAYER)
  float alpha = imagery_srgb.a;
  float share = paper.w;
#else
  const float alpha = 1.0, share = 1.0;
#endif
#if defined(SPECIAL_LAYER)
  imagery_srgb.rgb = toned(imagery_srgb.rgb, alpha, layer_tone);
  if (layer_look.y > 0.0) alpha = brightness(imagery_srgb.rgb);
  share *= part_shown(layer_look.x) * on_side(layer_look.z);
#if defined(BLENDED_LAYER)
  imagery_srgb.rgb = blended(imagery_srgb.rgb, alpha);
#endif
  if (surface_look.x < 0.0) {                    // the layer's shadow on the ground, behind the air
    color_srgb = vec4(through_air(vec3(0.0), 1.0), 1.0) * (alpha * share * shadow_of_layer);
    WRITE_DEPTH(1.0);
    return;
  }
  if (surface_look.x > 0.0) {                    // the layer's own limb is as smooth as the ground's
    float inside = towards_eye * abs(towards_eye);
    share *= clamp(inside / max(fwidth(inside), 1e-9), 0.0, 1.0);
  }
  vec3 color = layer_look.x < 0.0 ? imagery_srgb.rgb : lit(imagery_srgb.rgb, alpha, false);
#else
  vec3 color = lit(imagery_srgb.rgb, alpha, true);
#endif
#if defined(NUMBERS) || defined(BLENDED_LAYER)
  color_srgb = (layer_look.w > 0.0 ? vec4(imagery_srgb.rgb, alpha) : vec4(through_air(color, alpha), alpha)) * share;
#else
  color_srgb = vec4(through_air(color, alpha), alpha) * share;
#endif
  WRITE_DEPTH(1.0);
}

// Places of a long pixel's taps: a rank-1 lattice, evenly spaced along both sides and centred. Place i of n is i along
// the one side and i times a stride modulo n along the other.
struct Lattice {
  int n;
  float step;                    // 1/n
  float stride;                  // over n
};
const Lattice kThree = Lattice(3, 1.0 / 3.0, 2.0 / 3.0);
const Lattice kSeven = Lattice(7, 1.0 / 7.0, 3.0 / 7.0);

// Strides by n: of 3, and of 7 to 16.
const float strides[17] = float[](1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 3, 4, 5, 5, 5, 4, 7);

// Enough places for a pixel of that length: about one a texel. Three suffice up to two texels. A pixel may be long along
// its diagonal, where four to six places leave gaps.
Lattice lattice_of(float pixel_texels) {
  int n = int(min(ceil(0.9 * pixel_texels), 16.0));
  n = pixel_texels <= 2.0 ? 3 : max(n, 7);
  float step = 1.0 / float(n);
  return Lattice(n, step, strides[n] * step);
}

// Place i, from -0.5 to 0.5 along the pixel's sides.
vec2 place(Lattice lattice, int i) {
  return vec2(float(i) * lattice.step, fract(float(i) * lattice.stride + 0.5 * lattice.step)) +
         vec2(0.5 * lattice.step - 0.5, -0.5);
}
