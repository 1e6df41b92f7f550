#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "geo/body.h"
#include "surface/relief.h"
#include "view/ground.h"

namespace terrella::test {

/// Mountains that are known twice: as the tiles of a relief, and as a table that is looked up by code of its own.
class WavyGround {
 public:
  /// Up to `most_m` high and as deep, not exaggerated; `waves` from pole to pole, half as many round the planet.
  WavyGround(double most_m, double exaggeration, int waves = 9, const Ellipsoid& body = earth().ellipsoid)
      : body_(body), exaggeration_(exaggeration), relief_(std::make_shared<Relief>(body, grid(), exaggeration)) {
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kColumns; ++x) {
        const double lat = (90.0 - (y + 0.5) * kPixel_deg) * kRad, lon = (-180.0 + (x + 0.5) * kPixel_deg) * kRad;
        table_m_.push_back(
            static_cast<float>(0.5 * most_m * (std::sin(2.0 * waves * lat) + std::cos(waves * lon) * std::cos(lat))));
      }
    }
  }

  [[nodiscard]] static TileGrid grid() { return {.root_span_deg = 180.0, .tile_px = 64, .max_level = kLevel}; }

  void add_tile(const TileId& id) {
    HeightTile tile{.id = id, .side_px = 64, .heights_m = {}};
    const int pixels = 1 << (kLevel - id.level);  // pixels of the table in one pixel of the tile
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const auto row = static_cast<std::size_t>((id.y * 64 + y) * pixels),
                   column = static_cast<std::size_t>((id.x * 64 + x) * pixels);
        tile.heights_m.push_back(table_m_[row * kColumns + column]);
      }
    }
    const auto [least, most] = std::ranges::minmax(tile.heights_m);
    tile.min_m = least;
    tile.max_m = most;
    relief_->add(std::move(tile));
  }
  void add_level(int level) {
    for (std::int64_t y = 0; y < rows(grid(), level); ++y) {
      for (std::int64_t x = 0; x < columns(grid(), level); ++x) add_tile({level, x, y});
    }
  }

  [[nodiscard]] Relief& relief() { return *relief_; }
  [[nodiscard]] Ground ground() const { return {body_, relief_}; }
  [[nodiscard]] const Ellipsoid& body() const { return body_; }

  /// Exaggerated, bilinear between the table's numbers, which go on round the planet and end at the poles.
  [[nodiscard]] double truth_m(double lat_deg, double lon_deg) const {
    const double x = (lon_deg + 180.0) / kPixel_deg - 0.5, y = (90.0 - lat_deg) / kPixel_deg - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto at = [&](double column, double row) {
      const int c = (static_cast<int>(column) % kColumns + kColumns) % kColumns;
      const int r = std::clamp(static_cast<int>(row), 0, kRows - 1);
      return double{table_m_[static_cast<std::size_t>(r) * kColumns + static_cast<std::size_t>(c)]};
    };
    const double u = x - left, v = y - top;
    return exaggeration_ * ((at(left, top) * (1.0 - u) + at(left + 1.0, top) * u) * (1.0 - v) +
                            (at(left, top + 1.0) * (1.0 - u) + at(left + 1.0, top + 1.0) * u) * v);
  }

  static constexpr int kLevel = 3, kColumns = 1024, kRows = 512;
  static constexpr double kPixel_deg = 360.0 / kColumns, kRad = std::numbers::pi / 180.0;

 private:
  Ellipsoid body_;
  double exaggeration_;
  std::shared_ptr<Relief> relief_;
  std::vector<float> table_m_;
};

}  // namespace terrella::test
