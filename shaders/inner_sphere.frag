layout(location = 0) out vec4 color_srgb;

void main() {
  color_srgb = vec4(0.0, 0.0, 0.0, 1.0);
#if defined(DEPTH_LOGARITHMIC)
  float w = 1.0 / gl_FragCoord.w;
  gl_FragDepth = log2(w / clip_scale.z + 1.0) / log2(clip_scale.w / clip_scale.z + 1.0);
#endif
}
