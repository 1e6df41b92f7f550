flat in mat3 ecef_from_view;
flat in vec3 here;
flat in vec3 next;
flat in vec3 across;
flat in vec3 begins;
flat in vec3 ends;
flat in float half_width_px;
flat in vec4 line_color;

// Metres beside the line's vertical plane; false if there is no ground.
bool beside(ivec2 off, out float metres) {
  vec3 ground;
  bool is_there = ground_at(ecef_from_view, off, ground);
  metres = dot(across, ground - here);
  return is_there;
}

// Change over a pixel. Of two neighbours, the one on the same slope counts, and not the one beyond a ridge.
float change(ivec2 step, float metres) {
  float on, back;
  bool has_on = beside(step, on), has_back = beside(-step, back);
  float forth = on - metres, behind = metres - back;
  if (!has_on && !has_back) return 0.0;
  bool take_on = has_on && (!has_back || abs(forth) < abs(behind));
  return (take_on ? forth : behind) / float(step.x + step.y);
}

void main() {
  vec3 ground;
  if (!ground_at(ecef_from_view, ivec2(0), ground)) discard;
  precise float begun = dot(begins, ground - here), ended = dot(ends, ground - next);
  if (begun < 0.0 || ended >= 0.0) discard;
  float metres = dot(across, ground - here);
  vec2 slope = vec2(change(ivec2(1, 0), metres), change(ivec2(0, picture_at.z), metres));
  float per_px = length(slope);
  if (!(abs(metres) <= (half_width_px + 1.0) * per_px)) discard;
  // The line is thought to be where the slope reaches it. If another slope begins before, it is not.
  ivec2 off = ivec2(floor(-metres * slope / (per_px * per_px) + 0.5));
  off.y -= off.y % picture_at.z;
  float there;
  if (off != ivec2(0) && in_picture(ivec2(gl_FragCoord.xy) + off) &&
      (!beside(off, there) || abs(there) > 4.0 * (abs(metres) + per_px))) {
    discard;
  }
  // Round the outer side of a bend.
  vec3 way = normalize(next - here);
  float past = max(max(-dot(way, ground - here), dot(way, ground - next)), 0.0);
  float away_px = length(vec2(metres / per_px, past * focal_px() / length(ground)));
  float coverage = clamp(0.5 + half_width_px - away_px, 0.0, 1.0) * min(1.0, 2.0 * half_width_px);
  if (coverage <= 0.0) discard;
  color_srgb = vec4(line_color.rgb, line_color.a * coverage);
  if (!in_air()) return;
  vec3 through, light;
  air_before(ground, through, light);
  color_srgb.rgb = seen_through(color_srgb.rgb, through, light);
}
