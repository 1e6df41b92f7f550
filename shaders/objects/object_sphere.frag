in vec2 disc;

void main() { draw_sphere(disc, 1.0 / gl_FragCoord.w); }
