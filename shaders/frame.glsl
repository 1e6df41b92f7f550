// What every program knows of the frame. Mirrored by FrameBlock in engine/render/frame_block.h.
layout(std140, binding = 0) uniform Frame {
  mat4 view_from_ecef;     // rotation only
  vec4 eye_high_ecef;      // metres, high and low floats of the double position
  vec4 eye_low_ecef;
  vec4 clip_scale;         // x, y: focal lengths; z: near plane, metres; w: far plane, metres (standard and logarithmic depth)
  vec4 sun_ecef;           // unit; w: 1 lit, 0 imagery alone
  vec4 texels;             // tile_px over slot_px; slot_px; number of mip levels; polar scale of the row direction (TileGrid's latitude)
  vec4 paper;              // a, b of paper 1's formulas (5) and (6); 1 for equal-area rows; unused
};
