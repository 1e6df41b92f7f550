#include "apps/bench/truth/tile_border_mask.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace terrella::truth {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::int64_t kNoTile = -1;

// Number of the tile at a pixel. The row latitude is 90° times the sine for equal-area rows.
std::int64_t tile_number(const TruthImage& truth, std::size_t at, const Spheroid& body, const RowRule& rows,
                         double span_deg) {
  if (std::isnan(truth.lat_deg[at])) return kNoTile;
  double lat = static_cast<double>(truth.lat_deg[at]) * kDegree;
  const double squash = (1.0 - body.f) * (1.0 - body.f);
  if (rows.centric) lat = std::atan2(squash * std::sin(lat), std::cos(lat));
  const double row_latitude = rows.equal_area ? 90.0 * std::sin(lat) : lat / kDegree;
  const auto column =
      static_cast<std::int64_t>(std::floor((static_cast<double>(truth.lon_deg[at]) + 180.0) / span_deg));
  const auto row = static_cast<std::int64_t>(std::floor((90.0 - row_latitude) / span_deg));
  return (row << 32) + column;
}

Mask grown_along_rows(const Mask& mask, int reach_px) {
  Mask out{mask.width, mask.height, std::vector<std::uint8_t>(mask.set.size())};
  for (int y = 0; y < mask.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width);
    for (int x = 0; x < mask.width; ++x) {
      if (!mask.set[row + static_cast<std::size_t>(x)]) continue;
      const int last = std::min(mask.width - 1, x + reach_px);
      for (int i = std::max(0, x - reach_px); i <= last; ++i) out.set[row + static_cast<std::size_t>(i)] = 1;
    }
  }
  return out;
}

Mask transposed(const Mask& mask) {
  Mask out{mask.height, mask.width, std::vector<std::uint8_t>(mask.set.size())};
  for (std::size_t y = 0; y < static_cast<std::size_t>(mask.height); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(mask.width); ++x) {
      out.set[x * static_cast<std::size_t>(mask.height) + y] = mask.set[y * static_cast<std::size_t>(mask.width) + x];
    }
  }
  return out;
}

bool has_other_neighbour(const std::vector<std::int64_t>& tiles, int width, int height, int x, int y) {
  const auto tile_at = [&](int column, int row) {
    return tiles[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  };
  const std::int64_t own = tile_at(x, y);
  if (own == kNoTile) return false;
  for (int row = std::max(0, y - 1); row <= std::min(height - 1, y + 1); ++row) {
    for (int column = std::max(0, x - 1); column <= std::min(width - 1, x + 1); ++column) {
      const std::int64_t other = tile_at(column, row);
      if (other != own && other != kNoTile) return true;
    }
  }
  return false;
}

}  // namespace

Mask grown(const Mask& mask, int reach_px) {
  return transposed(grown_along_rows(transposed(grown_along_rows(mask, reach_px)), reach_px));
}

Mask tile_border_mask(const TruthImage& truth, const Spheroid& body, const RowRule& rows, const TileBorders& borders) {
  const double span_deg = borders.root_span_deg / std::exp2(borders.level);
  std::vector<std::int64_t> tiles(truth.lat_deg.size());
  for (std::size_t at = 0; at < tiles.size(); ++at) tiles[at] = tile_number(truth, at, body, rows, span_deg);
  Mask mask{truth.width, truth.height, std::vector<std::uint8_t>(tiles.size())};
  for (int y = 0; y < truth.height; ++y) {
    for (int x = 0; x < truth.width; ++x) {
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(truth.width) + static_cast<std::size_t>(x);
      mask.set[at] = has_other_neighbour(tiles, truth.width, truth.height, x, y);
    }
  }
  return mask;
}

}  // namespace terrella::truth
