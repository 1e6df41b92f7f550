// The surface's depth alone, before a translucent surface is drawn where its depth is equal.
void main() {
  WRITE_DEPTH(1.0);
}
