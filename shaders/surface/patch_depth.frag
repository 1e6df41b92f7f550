// Writes the surface's depth only. A translucent surface is then drawn where its depth is equal.
void main() {
  WRITE_DEPTH(1.0);
}
