#include "streaming/numbers/slope_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "streaming/georeference/length_unit.h"
#include "tiles/height_decoder.h"

namespace terrella {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kMostKept = 64;  // decoded tiles, for the rims of their neighbours

using Tile = std::shared_ptr<const std::vector<float>>;
using ReadTile = Result<Tile, TileFailure>;

/// The tiles around one, and why some are not there: each is read once.
using Neighbours = std::vector<std::pair<TileId, ReadTile>>;

/// Metres of a texel's sides.
struct TexelSize {
  double east_m = 1.0, north_m = 1.0;
};

/// Horn's angle of the middle one of 3x3 heights, rows from the north. Texels of a row near a pole are narrower than
/// those of the next row.
float angle_deg(std::array<float, 9> z, const std::array<TexelSize, 3>& sizes, GroundAngle angle) {
  if (std::isnan(z[4])) return kUnknown;
  for (float& height : z) height = std::isnan(height) ? z[4] : height;
  const auto rise = [&](std::size_t row) { return (double{z[3 * row + 2]} - z[3 * row]) / sizes[row].east_m; };
  const double east = (rise(0) + 2.0 * rise(1) + rise(2)) / 8.0;
  const double north = (z[0] + 2.0 * z[1] + z[2] - (z[6] + 2.0 * z[7] + z[8])) / (8.0 * sizes[1].north_m);
  if (angle == GroundAngle::slope) return static_cast<float>(std::atan(std::hypot(east, north)) * 180.0 / M_PI);
  if (east == 0.0 && north == 0.0) return kUnknown;
  const double faces_deg = std::atan2(-east, -north) * 180.0 / M_PI;
  return static_cast<float>(faces_deg < 0.0 ? faces_deg + 360.0 : faces_deg);
}

class SlopeTiles : public TileSource {
 public:
  SlopeTiles(std::shared_ptr<TileSource> heights, GroundAngle angle, const Ellipsoid& figure, double unit_m)
      : heights_(std::move(heights)), angle_(angle), figure_(figure), unit_m_(unit_m), info_(heights_->info()) {
    const bool slope = angle == GroundAngle::slope;
    info_.numbers =
        NumberInfo{.floats = true, .period = slope ? 0.0 : 360.0, .unit = "°", .quantity = slope ? "slope" : "aspect"};
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override { return read_or_stop(id, {}); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read_or_stop(const TileId& id, const std::stop_token& stop) override;
  [[nodiscard]] std::uint64_t edition() const override { return heights_->edition(); }
  // A tile depends on its neighbours, so a change of any tile is one of each.
  [[nodiscard]] Result<std::unique_ptr<TileSource>> at_time(UtcTime time) override {
    auto other = heights_->at_time(time);
    if (!other) return other.error();
    return std::unique_ptr<TileSource>(std::make_unique<SlopeTiles>(*std::move(other), angle_, figure_, unit_m_));
  }
  [[nodiscard]] std::optional<std::int64_t> count_tiles(int level) override { return heights_->count_tiles(level); }

 private:
  [[nodiscard]] ReadTile heights_m(const TileId& id, const std::stop_token& stop);
  [[nodiscard]] ReadTile neighbour(const TileId& id, Neighbours& neighbours, const std::stop_token& stop);
  [[nodiscard]] Result<std::vector<float>, TileFailure> row_beside(const TileId& id, std::int64_t row,
                                                                   Neighbours& neighbours, const std::stop_token& stop);
  [[nodiscard]] TexelSize size_at(const TileId& id, std::int64_t row) const;

  std::shared_ptr<TileSource> heights_;
  GroundAngle angle_;
  Ellipsoid figure_;
  double unit_m_;
  TileSetInfo info_;
  std::mutex mutex_;  ///< guards kept_ and kept_edition_
  std::deque<std::pair<TileId, Tile>> kept_;
  std::uint64_t kept_edition_ = 0;
};

ReadTile SlopeTiles::heights_m(const TileId& id, const std::stop_token& stop) {
  const std::uint64_t edition = heights_->edition();
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(kept_edition_, edition) != edition) kept_.clear();
    const auto known = std::ranges::find(kept_, id, &std::pair<TileId, Tile>::first);
    if (known != kept_.end()) return known->second;
  }
  const auto read = heights_->read_or_stop(id, stop);
  if (!read) return read.error();
  const NumberInfo& numbers = *heights_->info().numbers;
  auto decoded = decode_numbers(*read, numbers, info_.grid.tile_px);
  if (!decoded) return decoded.error();
  for (float& value : decoded->values) {
    const double number = static_cast<double>(value) * read->number_scale + read->number_offset;
    value = static_cast<float>((number * numbers.scale + numbers.offset) * unit_m_);
  }
  auto tile = std::make_shared<const std::vector<float>>(std::move(decoded->values));
  const std::lock_guard lock(mutex_);
  if (kept_edition_ != edition) return Tile(std::move(tile));
  kept_.emplace_back(id, tile);
  if (kept_.size() > kMostKept) kept_.pop_front();
  return Tile(std::move(tile));
}

ReadTile SlopeTiles::neighbour(const TileId& id, Neighbours& neighbours, const std::stop_token& stop) {
  const auto known = std::ranges::find(neighbours, id, &Neighbours::value_type::first);
  if (known != neighbours.end()) return known->second;
  ReadTile read = exists(info_.grid, id) ? heights_m(id, stop) : ReadTile(Tile());
  neighbours.emplace_back(id, read);
  return read;
}

// The heights of a row of the level at the middles of a tile's columns, and one more at each end. Rows near a pole may
// have texels of another width, between which heights are interpolated.
Result<std::vector<float>, TileFailure> SlopeTiles::row_beside(const TileId& id, std::int64_t row,
                                                               Neighbours& neighbours, const std::stop_token& stop) {
  const TileGrid& grid = info_.grid;
  const std::int64_t px = grid.tile_px, y = row >= 0 ? row / px : -1;
  std::vector<float> found(static_cast<std::size_t>(px) + 2, kUnknown);
  if (y < 0 || y >= rows(grid, id.level)) return found;
  const int squeeze = squeeze_of_row(grid, id.level, y);
  const double turn = std::ldexp(360.0 / tile_span_deg(grid, id.level) * static_cast<double>(px), -squeeze);
  std::optional<TileFailure> failed;
  TileId last{.level = -1};
  Tile tile;
  const auto height_at = [&](double texel) {
    texel += texel < 0.0 ? turn : texel >= turn ? -turn : 0.0;
    const auto column = static_cast<std::int64_t>(texel);
    const TileId there{.level = id.level, .x = column / px, .y = y, .squeeze = squeeze};
    if (there != last) {
      last = there;
      ReadTile read = neighbour(there, neighbours, stop);
      if (!read && read.error().kind == MissingKind::failed) failed = read.error();
      tile = read ? *std::move(read) : nullptr;
    }
    return tile ? (*tile)[static_cast<std::size_t>((row - y * px) * px + column % px)] : kUnknown;
  };
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double own = static_cast<double>(id.x * px) + static_cast<double>(i) - 0.5;
    const double at = std::ldexp(own, id.squeeze - squeeze) - 0.5, first = std::floor(at);
    const auto share = static_cast<float>(at - first);
    found[i] = height_at(first);
    if (share > 0.0F) found[i] += share * (height_at(first + 1.0) - found[i]);
  }
  if (failed) return *failed;
  return found;
}

TexelSize SlopeTiles::size_at(const TileId& id, std::int64_t row) const {
  const double texel_deg = tile_span_deg(info_.grid, id.level) / info_.grid.tile_px;
  const auto point = [&](double rows_down, double east_deg) {
    const double row_deg = top_row_deg(info_.grid) - (static_cast<double>(row) + rows_down) * texel_deg;
    const Angle lat = latitude_of_row(info_.grid, figure_, row_deg);
    return figure_.position(Ellipsoid::normal(lat, Angle::degrees(east_deg))).xyz_m;
  };
  return {.east_m = glm::distance(point(0.5, 0.0), point(0.5, std::ldexp(texel_deg, id.squeeze))),
          .north_m = glm::distance(point(0.0, 0.0), point(1.0, 0.0))};
}

Result<EncodedTile, TileFailure> SlopeTiles::read_or_stop(const TileId& id, const std::stop_token& stop) {
  if (auto own = heights_m(id, stop); !own) return own.error();
  const std::int64_t px = info_.grid.tile_px, first = id.y * px;
  const auto side = static_cast<std::size_t>(px);
  auto made = std::make_shared<Numbers>(Numbers{info_.grid.tile_px, info_.grid.tile_px, {}});
  made->values.reserve(side * side);
  std::array<std::vector<float>, 3> around;
  Neighbours neighbours;
  for (std::int64_t row = first - 1; row <= first + px; ++row) {
    auto next = row_beside(id, row, neighbours, stop);
    if (!next) return next.error();
    std::rotate(around.begin(), around.begin() + 1, around.end());
    around[2] = *std::move(next);
    if (row <= first) continue;
    const std::array sizes{size_at(id, row - 2), size_at(id, row - 1), size_at(id, row)};
    for (std::size_t i = 0; i < side; ++i) {
      std::array<float, 9> heights{};
      for (std::size_t k = 0; k < heights.size(); ++k) heights[k] = around[k / 3][i + k % 3];
      made->values.push_back(angle_deg(heights, sizes, angle_));
    }
  }
  EncodedTile tile;
  tile.make_numbers = [made]() -> Result<Numbers, TileFailure> { return *made; };
  return tile;
}

}  // namespace

Result<std::shared_ptr<TileSource>> slope_tiles(std::shared_ptr<TileSource> heights, GroundAngle angle,
                                                const Ellipsoid& figure, const std::string& name) {
  if (!heights->info().numbers) return Error{name + ": its tiles are pictures, and a slope needs heights"};
  const std::string& unit = heights->info().numbers->unit;
  const auto unit_m = metres_of_unit(unit);
  if (!unit_m) return Error{fmt::format("{}: {}", name, no_length(unit))};
  if (heights->remote() != nullptr) {
    return Error{name + ": a slope needs heights on this computer; ‹preload› them, and name that file"};
  }
  return std::shared_ptr<TileSource>(std::make_shared<SlopeTiles>(std::move(heights), angle, figure, *unit_m));
}

}  // namespace terrella
