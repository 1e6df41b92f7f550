#pragma once

#include <cstdint>
#include <vector>

namespace terrella {

/// Weighted sum for one column or row: source texels from `first` on, with weights that add up to 1.
struct Taps {
  std::int64_t first = 0;
  std::vector<float> weights;
};

/// Taps of a row, and the fraction of the row that has imagery, [0, 1]; 0 beyond the end of Web Mercator.
struct RowTaps {
  Taps taps;
  float coverage = 0.0F;
};

/// Catmull-Rom's cubic (Mitchell and Netravali 1988, B = 0, C = 1/2) around `centre`, in texels from the outer edge of
/// the first. A `length` over one texel makes it a low-pass filter of that many texels. Texels outside [0, count) take
/// the value of the edge; weights of 0 are left out. thread: any
[[nodiscard]] Taps cubic_taps(double centre, double length, std::int64_t count);

/// Taps of the columns of a tile. Its texels are `texels` source texels wide, at most 1, from source texel `first` on.
/// If `texels` is 1, a column is a source column. Source columns go on beyond ±180°; the caller wraps them.
[[nodiscard]] std::vector<Taps> column_taps(double first, double texels, int tile_px);

/// Taps of rows of equal latitude span, from a latitude southwards. Web Mercator has `source_rows` texels from end to
/// end.
[[nodiscard]] std::vector<RowTaps> row_taps(double north_deg, double span_deg, int tile_px, double source_rows);

}  // namespace terrella
