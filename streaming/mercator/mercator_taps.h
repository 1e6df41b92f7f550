#pragma once

#include <cstdint>
#include <vector>

namespace terrella {

/// What is summed for one column or row: source texels from `first` on, times weights, whose sum is 1.
struct Taps {
  std::int64_t first = 0;
  std::vector<float> weights;
};

/// Of a row: also which part of it has imagery at all, [0, 1]; none beyond the end of Web Mercator.
struct RowTaps {
  Taps taps;
  float coverage = 0.0F;
};

/// Catmull-Rom's cubic (Mitchell and Netravali 1988, B = 0, C = 1/2) around `centre`, in texels from the first one's
/// outer edge, `length` texels long where that is more than one: then it is a low-pass filter for as many. Texels
/// outside [0, count) are those at the edge, weights of 0 are left out. thread: any
[[nodiscard]] Taps cubic_taps(double centre, double length, std::int64_t count);

/// Columns of a tile whose texels are `texels` source texels wide, at most 1, from source texel `first` on. Where it is
/// 1 a column is a source column. Source columns run on beyond ±180°: who reads them wraps them.
[[nodiscard]] std::vector<Taps> column_taps(double first, double texels, int tile_px);

/// Rows from a latitude southwards, equal in latitude, over Web Mercator of `source_rows` texels from end to end.
[[nodiscard]] std::vector<RowTaps> row_taps(double north_deg, double span_deg, int tile_px, double source_rows);

}  // namespace terrella
