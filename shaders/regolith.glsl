// Light of dust on a body without air, such as the Moon: the lunar-Lambert law of A. McEwen, "Photometric functions for
// photoclinometry and other applications", Icarus 92 (1991). `sun` and `eye` are unit vectors, `normal` too. The full
// Moon is flat: its rim is as bright as its middle. 1 is the light of ground under Sun and eye at full phase.
float regolith_light(vec3 normal, vec3 sun, vec3 eye) {
  float incidence = dot(normal, sun), emission = max(dot(normal, eye), 0.0);
  if (incidence <= 0.0) return 0.0;
  float phase_deg = degrees(acos(clamp(dot(sun, eye), -1.0, 1.0)));
  float lunar = clamp(1.0 + phase_deg * (-0.019 + phase_deg * (0.242e-3 - 1.46e-6 * phase_deg)), 0.0, 1.0);
  return lunar * 2.0 * incidence / (incidence + emission) + (1.0 - lunar) * incidence;
}
