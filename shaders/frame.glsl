// What every program knows of the frame. Mirrored by FrameBlock in engine/render/frame_block.h.
layout(std140, binding = 0) uniform Frame {
  mat4 view_from_ecef;     // rotation only
  vec4 eye_high_ecef;      // metres, high and low floats of the double position
  vec4 eye_low_ecef;
  vec4 clip_scale;         // x, y: focal lengths; z: near plane, metres; w: far plane, metres (standard and logarithmic depth)
  vec4 sun_ecef;           // unit; w: 1 lit, 0 imagery alone
  vec4 texels;             // tile_px over slot_px; slot_px; number of mip levels; polar scale of the row direction (TileGrid's latitude)
  vec4 paper;              // a, b of paper 1's formulas (5) and (6); 1 for equal-area rows; opacity of a further layer
  vec4 layer_look;         // of a special layer: 1 shows by day, -1 by night, 0 by both; 1 brightness is alpha too; unused
};

// Depth as DepthMode stores it. `w` is the distance before the eye's plane, metres.

// As a vertex has it: times w. Logarithmic depth is written for each fragment, so that a vertex has the standard one.
float vertex_depth(float w) {
#if defined(DEPTH_REVERSED)
  return clip_scale.z;
#else
  return (w - clip_scale.z) * (clip_scale.w / (clip_scale.w - clip_scale.z));
#endif
}

// As a fragment has it.
float window_depth(float w) {
#if defined(DEPTH_REVERSED)
  return clip_scale.z / w;
#elif defined(DEPTH_LOGARITHMIC)
  return log2(w / clip_scale.z + 1.0) / log2(clip_scale.w / clip_scale.z + 1.0);
#else
  return (1.0 - clip_scale.z / w) * (clip_scale.w / (clip_scale.w - clip_scale.z));
#endif
}

// In a fragment's main(), at `pull` times its distance; other depths than the logarithmic come out of the vertices.
#if defined(DEPTH_LOGARITHMIC)
#define WRITE_DEPTH(pull) gl_FragDepth = window_depth((pull) / gl_FragCoord.w)
#else
#define WRITE_DEPTH(pull)
#endif
