// The functions of functions.glsl for a row of arguments, for comparison with double.
layout(binding = 0) uniform sampler2D arguments;   // y and x of atan; of asin; of sine and cosine
layout(binding = 1) uniform sampler2D radicands;   // argument of inversesqrt; two components of a length
layout(location = 0) out vec4 angles;              // atan, asin, sine, cosine
layout(location = 1) out vec4 roots;               // inversesqrt, length

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  vec4 a = texelFetch(arguments, here, 0);
  vec4 r = texelFetch(radicands, here, 0);
  angles = vec4(ATAN(a.x, a.y), ASIN(a.z), SIN_COS(a.w));
  roots = vec4(INVERSESQRT(r.x), LENGTH(r.yz), 0.0, 0.0);
}
