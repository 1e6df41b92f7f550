// The frame's data for every program. FrameBlock in engine/render/gl/frame_block.h has the same layout.
// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.
#if defined(BLENDED_LAYER)
#define SPECIAL_LAYER
#endif
#if defined(DIRECTIONS)
#define NUMBERS
#endif
layout(std140, binding = 0) uniform Frame {
  mat4 view_from_ecef;     // rotation only
  vec4 eye_high_ecef;      // metres, high and low floats of the double position
  vec4 eye_low_ecef;
  vec4 clip_scale;         // x, y: focal lengths; z: near plane, metres; w: far plane, metres (standard and logarithmic depth)
  vec4 sun_ecef;           // unit; w: 1 lit, 0 imagery only
  vec4 texels;             // tile_px over layer_px; layer_px; slot_px over layer_px; polar scale of the row direction (TileGrid's latitude)
  // Parameters a, b of paper 1's formulas (5) and (6); 1 for equal-area rows; opacity of an upper layer.
  vec4 paper;
  // Special layers: 1 shows by day, -1 by night, 0 by both; 1: brightness is also alpha; the layer shows to the left of
  // this place in the eye's picture, or to the right of its negative, pixels, or with 0 everywhere. Layers of numbers:
  // 1: neither lit nor seen through the air.
  vec4 layer_look;
  vec4 layer_tone;           // special layers: brightness, contrast, 1/gamma (ImageTone); 0: the colours stay as they are
  // Offsets from the eye, metres, into the axes of the horizon in scaled space (engine/render/sky/air_textures.h); the
  // last column has the square of the polar over the equatorial radius, one over the distance of the horizon, and
  // the eye's radius and height, metres. The last row is unused.
  mat4 horizon_from_ecef;
  // Exaggeration of the heights; 1: relief is lit from the north-west instead of by the Sun; slots of slopes: tile_px
  // over slot_px; pixels of this picture for a pixel of all sizes in pixels (Experiments::pixel_scale).
  vec4 relief;
  // Height of the layer over the ground, metres, or less than 0, in radii, for its shadow; light of the night side of a
  // body of dust; longest pixel, texels, for which oblique patches take three taps; 1 at a time, 0 if the Sun is only a
  // lamp.
  vec4 surface_look;
  // Place of the forward axis in the picture, pixels; slope of a pixel; left side of the eye's picture, pixels.
  vec4 axis_px;
  // The raised limb of PatchPass::set_limb(): its height, metres; square of the cosine towards the eye up to which it is
  // raised; LayerBlend of the layer.
  vec4 limb;
  // The square of the cosine by the place in the picture (LimbSquare of engine/surface/limb.h): a place, pixels, and the
  // slope there; the bend, and the square at that place.
  vec4 limb_at_px;
  vec4 limb_bend;
};

// Level ground and lamps by the sine of the Sun's height. Both change at the end of civil twilight
// (engine/surface/daylight.h): from there down the ground is dark and all lamps are lit.
const float kTwilightSine = 0.10452846;
float daylight(float sun_sine) { return smoothstep(-kTwilightSine, 0.3, sun_sine); }
float lamplight(float sun_sine) { return 1.0 - smoothstep(-kTwilightSine, 0.0, sun_sine); }

// Metres of air that count before a place near the ground: 1.2 times the eye's height does not
// (GroundColors of engine/sky/air_colors.h).
float air_metres(float away) { return max(away - 1.2 * horizon_from_ecef[3].w, 0.02 * away); }

// Depth in the format of DepthMode. `w` is the distance in front of the eye's plane, metres.

// Depth at a vertex, times w. Logarithmic depth is written per fragment, so here it equals standard depth.
float vertex_depth(float w) {
#if defined(DEPTH_REVERSED)
  return clip_scale.z;
#else
  return (w - clip_scale.z) * (clip_scale.w / (clip_scale.w - clip_scale.z));
#endif
}

// Depth at a fragment.
float window_depth(float w) {
#if defined(DEPTH_REVERSED)
  return clip_scale.z / w;
#elif defined(DEPTH_LOGARITHMIC)
  return log2(w / clip_scale.z + 1.0) / log2(clip_scale.w / clip_scale.z + 1.0);
#else
  return (1.0 - clip_scale.z / w) * (clip_scale.w / (clip_scale.w - clip_scale.z));
#endif
}

// Writes the depth of a point at `pull` times the fragment's distance, from main(). Only logarithmic depth needs this;
// other depths come from the vertices.
#if defined(DEPTH_LOGARITHMIC)
#define WRITE_DEPTH(pull) gl_FragDepth = window_depth((pull) / gl_FragCoord.w)
#else
#define WRITE_DEPTH(pull)
#endif
