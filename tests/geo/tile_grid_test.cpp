#include "tiles/tile_grid.h"

#include <gtest/gtest.h>

#include <GeographicLib/Ellipsoid.hpp>
#include <numbers>
#include <unordered_set>

#include "geo_test_support.h"

namespace terrella {
namespace {

using test::Draw;
using test::kEpsilon;
using test::kNaN;

// Degrees: a few roundings of an angle up to 90°.
constexpr double kAngleErrorDeg = 8.0 * kEpsilon * 90.0;

TileGrid grid_of(double root_span_deg, int max_level = kMaxTileLevel) {
  return {.root_span_deg = root_span_deg, .max_level = max_level};
}

GeoRect rect(double west, double south, double east, double north) {
  return {Angle::degrees(west), Angle::degrees(south), Angle::degrees(east), Angle::degrees(north)};
}

struct Matrix {
  std::int64_t columns, rows;
};

void expect_matrices(const TileGrid& grid, std::initializer_list<Matrix> matrices) {
  int level = 0;
  for (const Matrix& m : matrices) {
    EXPECT_EQ(columns(grid, level), m.columns) << level;
    EXPECT_EQ(rows(grid, level), m.rows) << level;
    ++level;
  }
}

TEST(TileGrid, MatricesOfTheKnownSets) {
  for (const int max_level : {6, 12, kMaxTileLevel}) {
    SCOPED_TRACE(max_level);
    expect_matrices(grid_of(180.0, max_level), {{2, 1}, {4, 2}, {8, 4}, {16, 8}});
    expect_matrices(grid_of(288.0, max_level), {{2, 1}, {3, 2}, {5, 3}, {10, 5}, {20, 10}, {40, 20}, {80, 40}});
    expect_matrices(grid_of(360.0, max_level), {{1, 1}, {2, 1}, {4, 2}, {8, 4}});
    // GIBS's span worked back from its scale denominator, which is rounded.
    const double from_scale = 512.0 * 223632905.6114871 * 0.00028 / (6378137.0 * 3.14159265358979 / 180.0);
    expect_matrices(grid_of(from_scale, max_level), {{2, 1}, {3, 2}, {5, 3}, {10, 5}, {20, 10}, {40, 20}, {80, 40}});
  }
  // 2^24 · 180° / 360°, to the last column.
  EXPECT_EQ(columns(grid_of(180.0), kMaxTileLevel), std::int64_t{1} << 25);
  EXPECT_EQ(rows(grid_of(288.0), kMaxTileLevel), (std::int64_t{5} << 24) / 8);
}

/// At the edge of a row that lies nearest to the equator: texel along the parallel over texel along the meridian.
double texel_shape(const TileGrid& grid, const TileId& id) {
  const TileBounds tile = tile_bounds(grid, id);
  const double lat = tile.south_deg >= 0.0 ? tile.south_deg : -tile.north_deg;
  const double width = (tile.east_deg - tile.west_deg) / (tile.north_deg - tile.south_deg);
  return width * std::cos(lat * std::numbers::pi / 180.0);
}

TEST(ReducedGrid, AFewTilesGoRoundAPoleAtEveryLevel) {
  TileGrid grid = grid_of(180.0);
  grid.reduced = true;
  for (int level = 3; level <= kMaxTileLevel; ++level) {
    SCOPED_TRACE(level);
    const std::int64_t last = rows(grid, level) - 1;
    const auto around = [&](std::int64_t y) { return columns(grid, level) >> squeeze_of_row(grid, level, y); };
    // engine/DESIGN.md, 12: 8 tiles in the first row and 16 in the second at every level.
    EXPECT_EQ(around(0), 8);
    EXPECT_EQ(around(last), 8);
    EXPECT_EQ(around(1), 16);
    EXPECT_EQ(around(last / 2), columns(grid, level)) << "the equator is not reduced";
  }
}

TEST(ReducedGrid, TexelsAreAFifthLongerAlongTheParallelAtMostAndNotHalfAsLong) {
  for (const double span : {180.0, 288.0, 256.0 * 64.0 / 60.0}) {
    TileGrid grid = grid_of(span);
    grid.reduced = true;
    for (int level = 3; level <= 14; ++level) {
      for (std::int64_t y = 0; y < rows(grid, level); ++y) {
        const int squeeze = squeeze_of_row(grid, level, y);
        if (squeeze == 0) continue;
        const double shape = texel_shape(grid, {level, 0, y, squeeze});
        ASSERT_LE(shape, 1.2 + 1e-8) << level << " " << y;
        // Not squeezed further either, but where eight tiles go round already.
        if (columns(grid, level) >> squeeze >= 16) {
          ASSERT_GT(shape, 0.6 - 1e-8) << level << " " << y;
        }
        ASSERT_GE(squeeze_of_row(grid, level - 1, y / 2), squeeze - 1) << "a parent spans what its children do";
      }
    }
  }
}

TEST(ReducedGrid, BothTilesOfAPlaceExist) {
  TileGrid grid = grid_of(180.0, 5);
  grid.reduced = true;
  const TileId wide = reduced_tile(grid, {5, 63, 0});
  EXPECT_EQ(wide, (TileId{5, 7, 0, 3}));
  EXPECT_TRUE(exists(grid, wide));
  EXPECT_TRUE(exists(grid, TileId{5, 63, 0})) << "the full grid has every tile as well";
  EXPECT_FALSE(exists(grid, TileId{5, 8, 0, 3})) << "beyond 180°";
  EXPECT_FALSE(exists(grid, TileId{5, 0, 0, 2})) << "that row is squeezed by 2³";
  EXPECT_EQ(tile_bounds(grid, wide).west_deg, 135.0);
  EXPECT_EQ(tile_bounds(grid, wide).east_deg, 180.0);
  grid.reduced = false;
  EXPECT_FALSE(exists(grid, wide));
  EXPECT_EQ(reduced_tile(grid, {5, 63, 0}), (TileId{5, 63, 0}));
}

TEST(TileGrid, PictureOf21600Pixels) {
  // 21600 / 256 = 84.375 and 10800 / 256 = 42.19 tiles at level 6, then halves.
  const TileGrid grid = grid_of(256.0 * 360.0 / 21600.0 * 64.0, 6);
  EXPECT_NEAR(grid.root_span_deg, 273.07, 0.005);  // the value for 21600 pixels and level 6
  expect_matrices(grid, {{2, 1}, {3, 2}, {6, 3}, {11, 6}, {22, 11}, {43, 22}, {85, 43}});
}

TEST(TileGrid, CutPicturesOfAnySizeCountWholeTiles) {
  Draw draw(41);
  for (int k = 0; k < 3000; ++k) {
    const int tile_px = 256 << draw.whole(0, 2);
    const int finest = draw.whole(0, 20);
    // Every other picture ends exactly on a tile's edge, where rounding would add a column.
    const std::int64_t tiles = draw.whole<std::int64_t>(1, std::int64_t{2} << finest);
    const std::int64_t width_px = k % 2 == 0 ? tiles * tile_px : tiles * tile_px - draw.whole(1, tile_px - 1);
    TileGrid grid = grid_of(std::ldexp(tile_px * (360.0 / static_cast<double>(width_px)), finest), finest);
    grid.tile_px = tile_px;
    for (int level = 0; level <= finest; ++level) {
      const std::int64_t span_px = std::int64_t{tile_px} << (finest - level);
      EXPECT_EQ(columns(grid, level), (width_px + span_px - 1) / span_px) << width_px << ' ' << level;
      EXPECT_EQ(rows(grid, level), (width_px + 2 * span_px - 1) / (2 * span_px)) << width_px << ' ' << level;
    }
  }
}

TEST(TileGrid, SpansPrintedWithNineDigitsCountTheSame) {
  // 21504 px are 84 tiles of 256; the span of level 0 is 274.285714 285…°, so the cut text asks for 84.00000009
  // columns.
  EXPECT_EQ(columns(grid_of(274.285714, 6), 6), 84);
  EXPECT_EQ(rows(grid_of(274.285714, 6), 6), 42);
}

TEST(TileGrid, OnePixelMoreIsAColumnOnEveryLevel) {
  // 2^20 tiles and one pixel: 4e-9 of a root tile, and yet its tiles must have ancestors.
  const int finest = 20;
  const double width_px = 256.0 * 0x1p20 + 1.0;
  const TileGrid grid = grid_of(std::ldexp(256.0 * 360.0 / width_px, finest), finest);
  for (int level = 0; level <= finest; ++level) EXPECT_EQ(columns(grid, level), (std::int64_t{1} << level) + 1);
}

TEST(TileGrid, DataJustOverATileEdgeReachesAllAncestors) {
  const int finest = 20;
  TileGrid grid = grid_of(180.0, finest);
  grid.bounds = rect(-10.0, 1.0, 1.5e-6 * tile_span_deg(grid, finest), 2.0);  // 1.5 slivers east of 0°
  TileId id{finest, std::int64_t{1} << finest, (std::int64_t{1} << finest) / 2 - 7000};
  for (; id.level > 0; id = parent(id)) EXPECT_TRUE(exists(grid, id)) << id.level;
  EXPECT_TRUE(exists(grid, id));
}

TEST(TileGrid, ExtremeSpansStillCount) {
  EXPECT_EQ(columns(grid_of(1e4), 0), 1);
  EXPECT_EQ(rows(grid_of(1e4), 0), 1);
  EXPECT_GT(columns(grid_of(1e-300), kMaxTileLevel), 0);
}

TEST(TileGrid, TilesOutsidePlanetAndLevelsDoNotExist) {
  TileGrid grid = grid_of(288.0, 5);
  grid.min_level = 1;
  EXPECT_FALSE(exists(grid, {0, 0, 0}));
  EXPECT_TRUE(exists(grid, {1, 2, 1}));
  EXPECT_FALSE(exists(grid, {1, 3, 1}));
  EXPECT_FALSE(exists(grid, {1, 2, 2}));
  EXPECT_FALSE(exists(grid, {1, -1, 0}));
  EXPECT_FALSE(exists(grid, {1, 0, -1}));
  EXPECT_TRUE(exists(grid, {5, 39, 19}));
  EXPECT_FALSE(exists(grid, {5, 40, 19}));
  EXPECT_FALSE(exists(grid, {6, 0, 0}));
}

TEST(TileGrid, BoundsThatCrossTheAntimeridian) {
  TileGrid grid = grid_of(180.0, kMaxTileLevel);
  grid.bounds = rect(170.0, -20.0, -170.0, 20.0);
  // Level 4: tiles of 11.25°, rows 6…9 reach over ±20°.
  EXPECT_TRUE(exists(grid, {4, 31, 7}));
  EXPECT_TRUE(exists(grid, {4, 0, 7}));
  EXPECT_FALSE(exists(grid, {4, 30, 7}));
  EXPECT_FALSE(exists(grid, {4, 1, 7}));
  EXPECT_FALSE(exists(grid, {4, 16, 7}));
  EXPECT_TRUE(exists(grid, {4, 31, 9}));
  EXPECT_FALSE(exists(grid, {4, 31, 10}));
  EXPECT_FALSE(exists(grid, {4, 31, 5}));
}

TEST(TileGrid, BoundsOnTileEdgesDoNotReachTheNextTile) {
  Draw draw(42);
  for (int k = 0; k < 2000; ++k) {
    const int level = draw.whole(1, 20);
    TileGrid grid = grid_of(k % 2 == 0 ? 180.0 : 288.0, level);
    const TileId id{level, draw.whole<std::int64_t>(0, columns(grid, level) - 1),
                    draw.whole<std::int64_t>(0, rows(grid, level) - 1)};
    const TileBounds b = tile_bounds(grid, id);
    grid.bounds = rect(b.west_deg, b.south_deg, b.east_deg, b.north_deg);
    EXPECT_TRUE(exists(grid, id));
    for (const int dx : {-1, 0, 1}) {
      for (const int dy : {-1, 0, 1}) {
        const TileId beside{level, id.x + dx, id.y + dy};
        EXPECT_EQ(exists(grid, beside), beside == id) << level << ' ' << id.x << ' ' << id.y << ' ' << dx << ' ' << dy;
      }
    }
  }
}

TEST(TileGrid, EveryTileHasItsParent) {
  Draw draw(43);
  for (int k = 0; k < 3000; ++k) {
    const int finest = draw.whole(1, kMaxTileLevel);
    TileGrid grid = grid_of(draw.between(170.0, 400.0), finest);
    const double west = draw.between(-180.0, 180.0);
    const double south = draw.between(-90.0, 89.0);
    const double width = std::exp(draw.between(std::log(1e-9), std::log(359.0)));
    grid.bounds = rect(west, south, std::remainder(west + width, 360.0), draw.between(south, 90.0));
    const TileXY corner = tile_xy(grid, finest, south, west);
    TileId id{finest, static_cast<std::int64_t>(corner.x), static_cast<std::int64_t>(corner.y)};
    // From the corner of the data the walk upwards must not fall off the grid, whatever slivers are dropped.
    bool found = exists(grid, id);
    while (id.level > 0) {
      id = parent(id);
      EXPECT_TRUE(exists(grid, id) || !found) << k << ' ' << id.level;
      found = exists(grid, id);
    }
    EXPECT_TRUE(found) << k;
  }
}

TEST(TileGrid, WholePlanetHasEveryTileOfItsMatrix) {
  const TileGrid grid = grid_of(256.0 * 360.0 / 21600.0 * 64.0, 6);
  for (int level = 0; level <= 6; ++level) {
    for (std::int64_t y = 0; y < rows(grid, level); ++y) {
      for (std::int64_t x = 0; x < columns(grid, level); ++x) EXPECT_TRUE(exists(grid, {level, x, y}));
    }
  }
}

TEST(TileGrid, ParentsAndAncestors) {
  EXPECT_EQ(parent(TileId{3, 7, 2}), (TileId{2, 3, 1}));
  EXPECT_EQ(ancestor(TileId{24, 33554431, 16777215}, 24), (TileId{0, 1, 0}));
  EXPECT_EQ(ancestor(TileId{5, 9, 9}, 0), (TileId{5, 9, 9}));
}

TEST(TileGrid, TileCoordinatesAndBoundsAgree) {
  Draw draw(44);
  for (int k = 0; k < 1000; ++k) {
    TileGrid grid = grid_of(draw.between(100.0, 400.0));
    if (k % 2 == 1) {
      grid.west_deg -= draw.between(0.0, 90.0);
      grid.north_deg += draw.between(0.0, 90.0);
    }
    const int level = draw.whole(0, kMaxTileLevel);
    const double lat = draw.between(-90.0, 90.0);
    const double lon = draw.between(-180.0, 180.0);
    const TileXY at = tile_xy(grid, level, lat, lon);
    const TileBounds b = tile_bounds(grid, {level, static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y)});
    const double rounding_deg = 8.0 * kEpsilon * 360.0;
    EXPECT_TRUE(exists(grid, {level, static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y)}));
    EXPECT_TRUE(b.west_deg <= lon + rounding_deg && lon <= b.east_deg + rounding_deg);
    EXPECT_TRUE(b.south_deg <= lat + rounding_deg && lat <= b.north_deg + rounding_deg);
    EXPECT_NEAR(b.east_deg - b.west_deg, tile_span_deg(grid, level), rounding_deg);
  }
  EXPECT_EQ(tile_xy(grid_of(180.0), 3, 90.0, -180.0).x, 0.0);
  EXPECT_EQ(tile_xy(grid_of(180.0), 3, -90.0, 190.0).y, 8.0);
  EXPECT_GT(tile_xy(grid_of(180.0), 3, -90.0, 190.0).x, 16.0);  // longitude is not wrapped
}

TileGrid rows_by(Projection projection, LatitudeKind latitude) {
  return {.projection = projection, .latitude = latitude};
}

TEST(TileGrid, RowLatitudesAgreeWithGeographicLib) {
  Draw draw(45);
  for (const Body& body : test::test_bodies()) {
    const GeographicLib::Ellipsoid reference(body.ellipsoid.a_m(), body.ellipsoid.f());
    for (int k = 0; k < 300; ++k) {
      const double lat = draw.between(-90.0, 90.0);
      const EcefDir n = Ellipsoid::normal(Angle::degrees(lat), Angle::degrees(draw.between(-180.0, 180.0)));
      const double centric = reference.GeocentricLatitude(lat);
      const auto row = [&](Projection p, LatitudeKind kind) {
        return row_latitude_deg(rows_by(p, kind), body.ellipsoid, n);
      };
      EXPECT_NEAR(row(Projection::equirectangular, LatitudeKind::graphic), lat, kAngleErrorDeg);
      EXPECT_NEAR(row(Projection::equirectangular, LatitudeKind::centric), centric, kAngleErrorDeg);
      EXPECT_NEAR(row(Projection::equal_area, LatitudeKind::graphic), 90.0 * std::sin(Angle::degrees(lat).rad()),
                  kAngleErrorDeg);
      EXPECT_NEAR(row(Projection::equal_area, LatitudeKind::centric), 90.0 * std::sin(Angle::degrees(centric).rad()),
                  kAngleErrorDeg);
    }
  }
}

TEST(TileGrid, RowsComeBack) {
  Draw draw(46);
  for (const Projection projection : {Projection::equirectangular, Projection::equal_area}) {
    for (const LatitudeKind latitude : {LatitudeKind::graphic, LatitudeKind::centric}) {
      const TileGrid grid = rows_by(projection, latitude);
      for (const Body& body : test::test_bodies()) {
        double last = -91.0;
        for (int k = 0; k <= 400; ++k) {
          const double row = -90.0 + k * 0.45;
          const Angle lat = latitude_of_row(grid, body.ellipsoid, row);
          const EcefDir n = Ellipsoid::normal(lat, Angle::degrees(77.0));
          EXPECT_NEAR(row_latitude_deg(grid, body.ellipsoid, n), row, kAngleErrorDeg) << body.name;
          EXPECT_GT(lat.deg(), last) << "rows rise with latitude";
          last = lat.deg();
        }
      }
    }
  }
}

TEST(TileGrid, PolesAreTheFirstAndLastRow) {
  for (const Projection projection : {Projection::equirectangular, Projection::equal_area}) {
    for (const LatitudeKind latitude : {LatitudeKind::graphic, LatitudeKind::centric}) {
      const TileGrid grid = rows_by(projection, latitude);
      for (const Body& body : test::test_bodies()) {
        for (const double pole : {90.0, -90.0}) {
          EXPECT_EQ(row_latitude_deg(grid, body.ellipsoid, {{0, 0, pole / 90.0}}), pole);
          EXPECT_EQ(latitude_of_row(grid, body.ellipsoid, pole).deg(), pole);
          EXPECT_EQ(latitude_of_row(grid, body.ellipsoid, 2.0 * pole).deg(), pole) << "clamped";
        }
        EXPECT_EQ(row_latitude_deg(grid, body.ellipsoid, {{0, -1, 0}}), 0.0);
        EXPECT_EQ(latitude_of_row(grid, body.ellipsoid, 0.0).deg(), 0.0);
      }
    }
  }
}

TEST(TileGrid, CloseToThePoleRowsKeepTheirDigits) {
  // A colatitude of 1e-10 rad is 0.6 mm on Earth; an arc sine would round it to 0 or 1.5e-8.
  const TileGrid grid = rows_by(Projection::equirectangular, LatitudeKind::centric);
  const double colatitude = 1e-10;
  const double row = row_latitude_deg(grid, earth().ellipsoid, {{colatitude, 0, 1}});
  const double centric_colatitude = colatitude / earth().ellipsoid.one_minus_e2();
  EXPECT_NEAR(Angle::degrees(90.0 - row).rad(), centric_colatitude, 2.0 * kEpsilon);  // an ulp of 90°
}

TEST(TileGrid, MarsLatitudesDifferByAThirdOfADegree) {
  const Body mars = *parse_body("mars");
  const TileGrid grid = rows_by(Projection::equirectangular, LatitudeKind::centric);
  const double row = row_latitude_deg(grid, mars.ellipsoid, Ellipsoid::normal(Angle::degrees(45.0), {}));
  EXPECT_NEAR(45.0 - row, 0.34, 0.005);  // the known value has two digits
}

TEST(TileGrid, NaNStaysNaN) {
  for (const Projection projection : {Projection::equirectangular, Projection::equal_area}) {
    const TileGrid grid = rows_by(projection, LatitudeKind::centric);
    EXPECT_TRUE(std::isnan(row_latitude_deg(grid, earth().ellipsoid, {{kNaN, 0, 1}})));
    EXPECT_TRUE(std::isnan(row_latitude_deg(grid, earth().ellipsoid, {{0, 0, kNaN}})));
    EXPECT_TRUE(std::isnan(latitude_of_row(grid, earth().ellipsoid, kNaN).rad()));
  }
}

TEST(TileGrid, EqualityLooksAtEveryField) {
  const TileGrid grid{};
  EXPECT_EQ(grid, TileGrid{});
  TileGrid other = grid;
  other.latitude = LatitudeKind::centric;
  EXPECT_FALSE(grid == other);
  other = grid;
  other.bounds.east = Angle::degrees(1.0);
  EXPECT_FALSE(grid == other);
  other = grid;
  other.root_span_deg = 288.0;
  EXPECT_FALSE(grid == other);
  other = grid;
  other.west_deg = -180.5;
  EXPECT_FALSE(grid == other);
}

TEST(TileGrid, HashesOfNearTilesDiffer) {
  std::unordered_set<std::size_t> hashes;
  std::size_t tiles = 0;
  for (const int level : {5, 6, 24}) {
    for (std::int64_t y = 0; y < 64; ++y) {
      for (std::int64_t x = 0; x < 64; ++x, ++tiles) hashes.insert(TileIdHash{}({level, x, y}));
    }
  }
  EXPECT_EQ(hashes.size(), tiles);
}

}  // namespace
}  // namespace terrella
