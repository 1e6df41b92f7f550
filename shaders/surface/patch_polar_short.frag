// Patches at a pole, and with `exact` every patch, whose pixels are up to two texels long: exact coordinates per
// fragment.
void main() { finish(seen(polar_mean(exact_window_point(), kThree))); }
