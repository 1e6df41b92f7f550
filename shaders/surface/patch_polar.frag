// As patch_polar_short.frag, for pixels up to seven texels long.
void main() { finish(seen(polar_mean(exact_window_point(), kSeven))); }
