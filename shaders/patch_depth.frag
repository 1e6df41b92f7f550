// The surface's depth alone, before a translucent surface is drawn where its depth is equal.
void main() {
#if defined(DEPTH_LOGARITHMIC)
  float w = 1.0 / gl_FragCoord.w;
  gl_FragDepth = log2(w / clip_scale.z + 1.0) / log2(clip_scale.w / clip_scale.z + 1.0);
#endif
}
