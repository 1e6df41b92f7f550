// Slopes of heights, against the analytic normals of the ground that the heights are samples of.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "geo/body.h"
#include "surface/height_field.h"
#include "surface/relief.h"

namespace terrella {
namespace {

constexpr double kSlopesRadian = std::numbers::pi / 180.0;
const TileGrid kSlopesGrid{.root_span_deg = 180.0, .tile_px = 32, .max_level = 2};
constexpr double kSlopesWave_m = 3.0e5, kSlopesWaves = 20.0;  // slopes up to 43°; 13 heights of the finest level a wave

double slopes_wave_m(double lat, double lon) {
  return kSlopesWave_m * std::sin(kSlopesWaves * lat) * std::cos(kSlopesWaves * lon);
}

glm::dvec3 slope_normal(double east, double north) { return glm::normalize(glm::dvec3(-east, -north, 1.0)); }

HeightTile slopes_waves(const TileId& id) {
  const TileBounds b = tile_bounds(kSlopesGrid, id);
  const double pixel_deg = (b.east_deg - b.west_deg) / kSlopesGrid.tile_px;
  HeightTile tile{.id = id, .side_px = kSlopesGrid.tile_px, .heights_m = {}};
  for (int k = 0; k < kSlopesGrid.tile_px * kSlopesGrid.tile_px; ++k) {
    const double lat = b.north_deg - (k / kSlopesGrid.tile_px + 0.5) * pixel_deg;
    const double lon = b.west_deg + (k % kSlopesGrid.tile_px + 0.5) * pixel_deg;
    tile.heights_m.push_back(static_cast<float>(slopes_wave_m(lat * kSlopesRadian, lon * kSlopesRadian)));
  }
  return tile;
}

/// Mean angle between the normals of a tile's slopes and the true ones, degrees.
double mean_slope_error_deg(const HeightField& field, const TileId& id, int border_px) {
  const double a_m = earth().ellipsoid.a_m();
  const TileBounds b = tile_bounds(kSlopesGrid, id);
  const double pixel_deg = (b.east_deg - b.west_deg) / kSlopesGrid.tile_px;
  const std::vector<glm::vec2> slopes = field.slopes(id, border_px);
  const int side = kSlopesGrid.tile_px + 2 * border_px;
  EXPECT_EQ(slopes.size(), static_cast<std::size_t>(side * side));
  double sum = 0.0;
  int n = 0;
  for (int k = 0; k < side * side; ++k) {
    const double lat = (b.north_deg - (k / side - border_px + 0.5) * pixel_deg) * kSlopesRadian;
    const double lon = (b.west_deg + (k % side - border_px + 0.5) * pixel_deg) * kSlopesRadian;
    if (std::abs(lat) > 60.0 * kSlopesRadian) continue;
    const double east = -kSlopesWave_m * kSlopesWaves * std::sin(kSlopesWaves * lat) * std::sin(kSlopesWaves * lon) /
                        (a_m * std::cos(lat));
    const double north =
        kSlopesWave_m * kSlopesWaves * std::cos(kSlopesWaves * lat) * std::cos(kSlopesWaves * lon) / a_m;
    const glm::vec2 slope = slopes[static_cast<std::size_t>(k)];
    const double cosine =
        std::min(1.0, glm::dot(slope_normal(east, north), slope_normal(double(slope.x), double(slope.y))));
    sum += std::acos(cosine) / kSlopesRadian;
    ++n;
  }
  return sum / n;
}

TEST(HeightSlopes, AreThoseOfTheNormalsAlsoInTheBorderAndRoundThePlanet) {
  constexpr double kMean_deg = 3.0;
  HeightField field(earth().ellipsoid, kSlopesGrid);
  for (std::int64_t y = 0; y < rows(kSlopesGrid, 2); ++y) {
    for (std::int64_t x = 0; x < columns(kSlopesGrid, 2); ++x) field.add(slopes_waves({.level = 2, .x = x, .y = y}));
  }
  for (const std::int64_t x : {0, 3, 7}) {
    for (const std::int64_t y : {1, 2})
      EXPECT_LE(mean_slope_error_deg(field, {.level = 2, .x = x, .y = y}, 2), kMean_deg);
  }
}

TEST(HeightSlopes, TakeCoarserHeightsWhereANeighbourIsMissing) {
  HeightField field(earth().ellipsoid, kSlopesGrid);
  for (std::int64_t x = 0; x < 4; ++x) {
    for (std::int64_t y = 0; y < 2; ++y) field.add(slopes_waves({.level = 1, .x = x, .y = y}));
  }
  const TileId alone{.level = 2, .x = 3, .y = 1};
  field.add(slopes_waves(alone));
  // Heights of two pixels' distance stray in two rings of 32 pixels.
  EXPECT_LE(mean_slope_error_deg(field, alone, 0), 5.0);
}

TEST(HeightSlopes, BeyondTheFinestLevelBendEvenlyBetweenTheHeights) {
  HeightField field(earth().ellipsoid, kSlopesGrid);
  for (std::int64_t y = 0; y < rows(kSlopesGrid, 2); ++y) {
    for (std::int64_t x = 0; x < columns(kSlopesGrid, 2); ++x) {
      field.add(slopes_waves({.level = 2, .x = x, .y = y}));
    }
  }
  for (const std::int64_t x : {0, 26, 63})
    EXPECT_LE(mean_slope_error_deg(field, {.level = 5, .x = x, .y = 14}, 1), 3.0);
  // Eight slopes to a height: neighbours differ by a fraction of what heights' slopes do, also at the tiles' borders.
  const std::vector<glm::vec2> slopes = field.slopes({.level = 5, .x = 31, .y = 15}, 1);
  float most = 0.0F;
  for (std::size_t k = 2; k < 34; ++k) {
    most = std::max(most, std::abs(slopes[k].x - 2.0F * slopes[k - 1].x + slopes[k - 2].x));
  }
  EXPECT_LT(most, 0.01F);
}

// A hill of 17 degrees beside a pole. Rows of the border lie beyond the pole; their colatitudes are negative.
TEST(HeightSlopes, AreThoseOfTheNormalsAcrossThePoles) {
  constexpr double kHill_m = 1.1e6, kHill_rad = 0.3, kMost_deg = 3.0;
  constexpr int kBorder = 2;
  const double a_m = earth().ellipsoid.a_m();
  const auto from_top = [](double c, double lon) {
    return glm::dvec2(c * std::sin(lon) - 0.1, c * std::cos(lon) + 0.05) / kHill_rad;
  };
  const auto height_m = [&](const glm::dvec2& p) { return kHill_m * std::exp(-glm::dot(p, p)); };
  for (const bool north : {true, false}) {
    HeightField field(earth().ellipsoid, kSlopesGrid);
    const auto place = [&](const TileId& id, int row, int column) {
      const TileBounds b = tile_bounds(kSlopesGrid, id);
      const double pixel_deg = (b.east_deg - b.west_deg) / kSlopesGrid.tile_px;
      const double lat = b.north_deg - (row + 0.5) * pixel_deg;
      return glm::dvec2(90.0 - (north ? lat : -lat), b.west_deg + (column + 0.5) * pixel_deg) * kSlopesRadian;
    };
    const std::int64_t y = north ? 0 : rows(kSlopesGrid, 2) - 1;
    for (std::int64_t x = 0; x < columns(kSlopesGrid, 2); ++x) {
      HeightTile tile{.id = {.level = 2, .x = x, .y = y}, .side_px = kSlopesGrid.tile_px, .heights_m = {}};
      for (int k = 0; k < kSlopesGrid.tile_px * kSlopesGrid.tile_px; ++k) {
        const glm::dvec2 at = place(tile.id, k / kSlopesGrid.tile_px, k % kSlopesGrid.tile_px);
        tile.heights_m.push_back(static_cast<float>(height_m(from_top(at.x, at.y))));
      }
      field.add(tile);
    }
    for (const std::int64_t x : {1, 6}) {
      const TileId id{.level = 2, .x = x, .y = y};
      const int side = kSlopesGrid.tile_px + 2 * kBorder;
      const std::vector<glm::vec2> slopes = field.slopes(id, kBorder);
      double most_deg = 0.0;
      for (int k = 0; k < 6 * side; ++k) {
        const int row = north ? k / side - kBorder : kSlopesGrid.tile_px + kBorder - 1 - k / side;
        const glm::dvec2 at = place(id, row, k % side - kBorder), p = from_top(at.x, at.y);
        const glm::dvec2 rise = -2.0 / kHill_rad * height_m(p) * p;  // a radian, along both axes
        const glm::dvec2 along(std::sin(at.y), std::cos(at.y)), across(std::cos(at.y), -std::sin(at.y));
        const double east = glm::dot(rise, across) * at.x / (a_m * std::sin(at.x));
        const double away = glm::dot(rise, along) / a_m;
        const glm::vec2 slope = slopes[static_cast<std::size_t>((row + kBorder) * side + k % side)];
        const double cosine = glm::dot(slope_normal(east, north ? -away : away), slope_normal(slope.x, slope.y));
        most_deg = std::max(most_deg, std::acos(std::min(1.0, cosine)) / kSlopesRadian);
      }
      EXPECT_LE(most_deg, kMost_deg) << (north ? "north" : "south") << ", tile " << x;
    }
  }
}

// Heights in whole metres of a plain that rises by one metre in a hundred: no cliffs between columns that are metres
// apart. Rounding by half a metre over half a pixel of the meridian is up to 0.0008 here.
TEST(HeightSlopes, OfRoundedHeightsHaveNoCliffsBesideAPole) {
  constexpr TileGrid kFine{.root_span_deg = 180.0, .tile_px = 256, .max_level = 5};
  const double metres_a_rad = earth().ellipsoid.a_m();
  const TileId id{.level = 5, .x = 3, .y = 0};
  const TileBounds b = tile_bounds(kFine, id);
  const double pixel_rad = (b.east_deg - b.west_deg) / kFine.tile_px * kSlopesRadian;
  HeightField field(earth().ellipsoid, kFine);
  HeightTile tile{.id = id, .side_px = kFine.tile_px, .heights_m = {}};
  for (int k = 0; k < kFine.tile_px * kFine.tile_px; ++k) {
    const double c = (k / kFine.tile_px + 0.5) * pixel_rad;
    const double lon = b.west_deg * kSlopesRadian + (k % kFine.tile_px + 0.5) * pixel_rad;
    tile.heights_m.push_back(static_cast<float>(std::round(0.01 * metres_a_rad * c * std::sin(lon))));
  }
  field.add(tile);
  const std::vector<glm::vec2> slopes = field.slopes(id, 0);
  constexpr int kReach =
      96;  // columns whose heights are all in this tile, and rows where they are not next to the pole
  for (int y = 32; y < kFine.tile_px; ++y) {
    for (int x = kReach; x < kFine.tile_px - kReach; ++x) {
      const double lon = b.west_deg * kSlopesRadian + (x + 0.5) * pixel_rad;
      EXPECT_NEAR(slopes[static_cast<std::size_t>(y * kFine.tile_px + x)].x, 0.01 * std::cos(lon), 0.001)
          << x << ", " << y;
    }
  }
}

TEST(HeightSlopes, BesideAPoleAreOutOfDateWhenHeightsBeyondItChange) {
  const TileId own{.level = 2, .x = 1, .y = 0}, beyond{.level = 2, .x = 5, .y = 0};
  for (const bool beside : {true, false}) {
    Relief relief(earth().ellipsoid, kSlopesGrid, 1.0, std::size_t{1} << 30U);
    relief.add(slopes_waves(own));
    const std::vector<glm::vec2> before = relief.field().slopes(own, 1);
    const std::uint64_t since = relief.changes_seen();
    relief.add(slopes_waves(beside ? beyond : TileId{.level = 2, .x = 5, .y = 2}));
    EXPECT_EQ(relief.field().slopes(own, 1) != before, beside);
    EXPECT_EQ(relief.changed_since(own, since), beside);
  }
}

TEST(HeightSlopes, OfLevelGroundAreZeroAndFiniteAtThePoles) {
  HeightField field(earth().ellipsoid, kSlopesGrid);
  HeightTile tile = slopes_waves({.level = 2, .x = 5, .y = 0});
  field.add(tile);
  for (const glm::vec2& slope : field.slopes(tile.id, 2)) EXPECT_TRUE(std::isfinite(slope.x + slope.y));
  tile.heights_m.assign(tile.heights_m.size(), 0.0F);
  field.add(tile);
  for (const glm::vec2& slope : field.slopes(tile.id, 2)) EXPECT_EQ(slope, glm::vec2(0.0F));
}

}  // namespace
}  // namespace terrella
