// Blocks of a picture of small spheres, side by side.
layout(location = 0) in uvec4 run;           // column and row of the first, how many, which of the buffer's the first is

noperspective out vec2 in_run_px;
flat out uint first_pixel;

const uvec2 kBlock_px = uvec2(64, 32);       // kSplatBlockWidth_px, kSplatBlockHeight_px

void main() {
  in_run_px = vec2(gl_VertexID & 1, gl_VertexID >> 1) * vec2(uvec2(run.z, 1) * kBlock_px);
  first_pixel = run.w * 2 * kBlock_px.x * kBlock_px.y;
  gl_Position = vec4(2.0 * (vec2(run.xy * kBlock_px) + in_run_px) / viewport_px - 1.0, 0.5, 1.0);
}
