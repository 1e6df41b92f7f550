// Marks the right eye's rows: the odd ones, counted from the top.
layout(location = 0) uniform int height_px;

void main() {
  if (((height_px - 1 - int(gl_FragCoord.y)) & 1) == 0) discard;
}
