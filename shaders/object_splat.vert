// One block of a picture of small spheres an instance.
layout(location = 0) in uint place;          // column in the low half, row in the high one

out vec2 in_block_px;
flat out int first_pixel;

const int kBlock_px = 32;                    // kSplatBlock_px

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  in_block_px = corner * kBlock_px;
  first_pixel = gl_InstanceID * 2 * kBlock_px * kBlock_px;
  vec2 at_px = (vec2(place & 0xFFFFu, place >> 16) + corner) * kBlock_px;
  gl_Position = vec4(2.0 * at_px / viewport_px - 1.0, 0.5, 1.0);
}
