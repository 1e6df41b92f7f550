layout(location = 1) uniform float shade;
layout(location = 0) out float color;

void main() {
  color = shade;
  WRITE_DEPTH(1.0);
}
