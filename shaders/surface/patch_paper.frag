// `paper`: formulas (5) and (6) of paper 1 inside the bands v < b and v > 1 - b; elsewhere interpolated coordinates.
// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.

// Returns the level of detail of a texture query on the whole picture at its finest level.
float query_level(WindowPoint w, Cell cell) {
  float finest = cell.scale.y * texels.y * exp2(row.y);
  return 0.5 * log2(max(dot(w.dx, w.dx), dot(w.dy, w.dy)) * finest * finest);
}

void main() {
  WindowPoint w = exact_window_point();
  float row_deg = row.x - (w.p.y - center_and_scale.y) / center_and_scale.w;
  float v = 0.5 - row_deg / 180.0;
  float b = paper.y;
  bool north = v < b, south = v > 1.0 - b;
  if (!north && !south) w = WindowPoint(window_point, dFdx(window_point), dFdy(window_point));
  Cell cell = cell_at(w.p);
  float level = query_level(w, cell);
  if (north || south) {
    float v_hat = north ? 1.0 - v / b : (v - (1.0 - b)) / b;                 // (5)
    float most = 64.0;                                                       // limit, because (6) divides by zero
    level = min(most, max(0.0, level - 1.0) / max(paper.x * v_hat, 1e-6));  // (6)
  }
  level = clamp(level - row.y, 0.0, float(kSlotMips - 1));
  finish(seen(mip_tap(cell, w.p, level)));
}
