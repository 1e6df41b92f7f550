#include "surface/height_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "geo/body.h"
#include "tests/geo/geo_test_support.h"

namespace terrella {
namespace {

using test::Draw;

/// Doubles of a few thousand metres, summed in another order.
constexpr double kSum_m = 1e-8;
constexpr int kTile_px = 20;  // no multiple of a block

/// Any height for a pixel of a level, the same each time.
float height_of(int level, std::int64_t x, std::int64_t y) {
  const auto mixed =
      static_cast<std::uint64_t>(x * 7919 + y * 104729 + std::int64_t{level} * 1299709) * 0x9E3779B97F4A7C15ULL;
  return static_cast<float>(mixed >> 44) * (20000.0F / 1048576.0F) - 10000.0F;
}

HeightTile tile_at(const TileGrid& grid, const TileId& id) {
  HeightTile tile{.id = id, .side_px = grid.tile_px, .heights_m = {}};
  for (int y = 0; y < grid.tile_px; ++y) {
    for (int x = 0; x < grid.tile_px; ++x) {
      tile.heights_m.push_back(height_of(id.level, id.x * grid.tile_px + x, id.y * grid.tile_px + y));
    }
  }
  return tile;
}

TileGrid grid_of(double root_span_deg, int max_level, Projection projection = Projection::equirectangular,
                 LatitudeKind latitude = LatitudeKind::graphic) {
  return {.root_span_deg = root_span_deg,
          .tile_px = kTile_px,
          .min_level = 0,
          .max_level = max_level,
          .projection = projection,
          .latitude = latitude};
}

std::vector<TileId> tiles_of(const TileGrid& grid, int level) {
  std::vector<TileId> ids;
  for (std::int64_t y = 0; y < rows(grid, level); ++y) {
    for (std::int64_t x = 0; x < columns(grid, level); ++x) ids.push_back({.level = level, .x = x, .y = y});
  }
  return ids;
}

/// The same heights by the words of the contract: each pixel whose middle is less than a pixel away weighs by the
/// tent of its distance. Walks over all pixels of the level, and knows which tiles are there.
class Reference {
 public:
  Reference(const TileGrid& grid, std::set<TileId> there) : grid_(grid), there_(std::move(there)) {}

  [[nodiscard]] double height_m(double row_deg, double lon_deg) const {
    const double lon = lon_deg >= 180.0 ? lon_deg - 360.0 : lon_deg;
    const TileId* own = nullptr;
    for (const TileId& id : there_) {  // ascending levels: the last one is the finest
      const TileBounds box = tile_bounds(grid_, id);
      const bool last_row = id.y + 1 == rows(grid_, id.level);
      if (lon >= box.west_deg && lon < box.east_deg && row_deg <= box.north_deg &&
          (row_deg > box.south_deg || last_row)) {
        own = &id;
      }
    }
    return own == nullptr ? 0.0 : tent(*own, row_deg, lon);
  }

 private:
  [[nodiscard]] double tent(const TileId& own, double row_deg, double lon_deg) const {
    const double pixel_deg = grid_.root_span_deg / grid_.tile_px / static_cast<double>(1 << own.level);
    const double x = (lon_deg + 180.0) / pixel_deg;
    const double y = (90.0 - row_deg) / pixel_deg;
    const auto turn = static_cast<std::int64_t>(std::ceil(360.0 / pixel_deg - 1e-6));
    const auto height = static_cast<std::int64_t>(std::ceil(180.0 / pixel_deg - 1e-6));
    double sum = 0.0;
    for (std::int64_t row = -1; row <= height; ++row) {
      const double south = 1.0 - std::abs(y - (static_cast<double>(row) + 0.5));
      if (south <= 0.0) continue;
      const std::int64_t held_row = row < 0 ? 0 : row == height ? height - 1 : row;
      for (std::int64_t column = -1; column <= turn; ++column) {
        const double east = 1.0 - std::abs(x - (static_cast<double>(column) + 0.5));
        if (east > 0.0) sum += south * east * round_planet(own, column, held_row, 360.0 / pixel_deg);
      }
    }
    return sum;
  }

  [[nodiscard]] double round_planet(const TileId& own, std::int64_t column, std::int64_t row, double turn) const {
    const auto last = static_cast<std::int64_t>(std::ceil(turn - 1e-6)) - 1;
    if (column >= 0 && column <= last) return pixel(own, column, row);
    const double place = static_cast<double>(column) + (column < 0 ? turn : -turn);
    double sum = 0.0;
    for (std::int64_t at = 0; at <= last; ++at) {
      const double share = 1.0 - std::abs(place - static_cast<double>(at));
      if (share > 1e-6) sum += share * pixel(own, at, row);
    }
    return sum;
  }

  /// The pixel if its tile is there, else the nearest one of the tile that the point is in.
  [[nodiscard]] double pixel(const TileId& own, std::int64_t column, std::int64_t row) const {
    const TileId holder{.level = own.level, .x = column / grid_.tile_px, .y = row / grid_.tile_px};
    if (there_.contains(holder)) return static_cast<double>(height_of(own.level, column, row));
    double best = std::numeric_limits<double>::infinity();
    double height = 0.0;
    const double turn = 360.0 * grid_.tile_px * static_cast<double>(1 << own.level) / grid_.root_span_deg;
    for (std::int64_t y = own.y * grid_.tile_px; y < (own.y + 1) * grid_.tile_px; ++y) {
      for (std::int64_t x = own.x * grid_.tile_px; x < (own.x + 1) * grid_.tile_px; ++x) {
        const double across = std::abs(static_cast<double>(x - column));
        const double away = std::min(across, std::abs(turn - across)) + std::abs(static_cast<double>(y - row));
        if (away >= best) continue;
        best = away;
        height = static_cast<double>(height_of(own.level, x, y));
      }
    }
    return height;
  }

  TileGrid grid_;
  std::set<TileId> there_;
};

/// A field, and what is in it.
struct Filled {
  HeightField field;
  std::set<TileId> there;
};

Filled fill(const TileGrid& grid, const Ellipsoid& ellipsoid, Draw& draw, int one_in) {
  Filled made{HeightField(ellipsoid, grid), {}};
  for (int level = 0; level <= grid.max_level; ++level) {
    for (const TileId& id : tiles_of(grid, level)) {
      if (one_in > 1 && draw.whole(1, one_in) == 1) continue;
      made.field.add(tile_at(grid, id));
      made.there.insert(id);
    }
  }
  return made;
}

const Ellipsoid kEarth = parse_body("earth")->ellipsoid;

/// Any longitude; one in four on ±180°, a tile's border or a pixel's middle.
double some_lon(Draw& draw, const TileGrid& grid) {
  const double pixel_deg = tile_span_deg(grid, grid.max_level) / grid.tile_px;
  const int kind = draw.whole(0, 15);
  if (kind == 0) return draw.whole(0, 1) == 0 ? 180.0 : -180.0;
  if (kind == 1) return -180.0 + 10.0 * pixel_deg * draw.whole(0, 15);
  if (kind == 2) return -180.0 + pixel_deg * (0.5 + draw.whole(0, 100));
  if (kind == 3) return 180.0 - draw.between(0.0, pixel_deg);
  return draw.between(-180.0, 180.0);
}

double some_row(Draw& draw) {
  const int kind = draw.whole(0, 11);
  return kind == 0 ? 90.0 : kind == 1 ? -90.0 : draw.between(-90.0, 90.0);
}

class HeightFieldGrids : public testing::TestWithParam<double> {};

TEST_P(HeightFieldGrids, IsWhatTheContractSaysWithAllTilesAndWithSome) {
  const TileGrid grid = grid_of(GetParam(), 2);
  for (const int one_in : {1, 2, 3}) {
    Draw draw(11 + static_cast<unsigned>(one_in));
    const Filled filled = fill(grid, kEarth, draw, one_in);
    const Reference reference(grid, filled.there);
    for (int i = 0; i < 250; ++i) {
      const double row = some_row(draw);
      const double lon = some_lon(draw, grid);
      ASSERT_NEAR(filled.field.height_at_row_m(row, lon), reference.height_m(row, lon), kSum_m)
          << "row " << row << ", lon " << lon << ", one in " << one_in << " lacks";
    }
  }
}

TEST_P(HeightFieldGrids, RangesHoldEveryHeight) {
  const TileGrid grid = grid_of(GetParam(), 3);
  for (const int one_in : {1, 2, 4}) {
    Draw draw(5 + static_cast<unsigned>(one_in));
    const Filled filled = fill(grid, kEarth, draw, one_in);
    for (int i = 0; i < 200; ++i) {
      const double west = some_lon(draw, grid);
      const double width = draw.whole(0, 4) == 0 ? 0.0 : std::pow(10.0, draw.between(-2.0, 2.3));
      const double east = west + width > 180.0 ? west + width - 360.0 : west + width;
      const double south = some_row(draw);
      const double north = std::min(90.0, south + draw.between(0.0, 30.0));
      const GeoRect box{Angle::degrees(west), Angle::degrees(south), Angle::degrees(east), Angle::degrees(north)};
      const GroundRange range = filled.field.range_m(box);
      for (int point = 0; point < 20; ++point) {
        const double lon = point == 0 ? west : point == 1 ? west + width : draw.between(west, west + width);
        const double row = point == 2 ? south : point == 3 ? north : draw.between(south, north);
        const double height = filled.field.height_at_row_m(row, lon);
        ASSERT_GE(height, range.min_m - kSum_m) << west << " " << south << " " << width << " " << north;
        ASSERT_LE(height, range.max_m + kSum_m) << west << " " << south << " " << width << " " << north;
      }
    }
  }
}

// WorldCRS84Quad, GIBS, one root, a picture whose coarse levels have no whole number of pixels in 360°.
INSTANTIATE_TEST_SUITE_P(RootSpans, HeightFieldGrids, testing::Values(180.0, 288.0, 360.0, 80.0 * 360.0 / 90.0));

TEST(HeightField, AnOriginBesideThePlanetsCornerMovesTiles) {
  TileGrid moved = grid_of(180.0, 1);
  const TileGrid usual = moved;
  moved.west_deg = -270.0;
  moved.north_deg = 180.0;
  HeightField there(kEarth, moved);
  HeightField expected(kEarth, usual);
  for (const TileId& id : tiles_of(usual, 1)) {
    HeightTile tile = tile_at(usual, id);
    expected.add(tile);
    tile.id = {.level = 1, .x = id.x + 1, .y = id.y + 1};
    there.add(std::move(tile));
  }
  Draw draw(17);
  for (int i = 0; i < 500; ++i) {
    const double row = draw.between(-85.0, 80.0);
    const double lon = draw.between(-170.0, 165.0);  // pixels of 4.5° and boxes of 3° stay off ±180°
    ASSERT_NEAR(there.height_at_row_m(row, lon), expected.height_at_row_m(row, lon), kSum_m) << row << ' ' << lon;
    const GeoRect box{.west = Angle::degrees(lon),
                      .south = Angle::degrees(row),
                      .east = Angle::degrees(lon + 3.0),
                      .north = Angle::degrees(row + 3.0)};
    EXPECT_EQ(there.range_m(box, 1.0).max_m, expected.range_m(box, 1.0).max_m) << row << ' ' << lon;
  }
}

TEST(HeightField, RowsCountAsTheGridSays) {
  const Ellipsoid mars = parse_body("mars")->ellipsoid;
  for (const Projection projection : {Projection::equirectangular, Projection::equal_area}) {
    for (const LatitudeKind latitude : {LatitudeKind::graphic, LatitudeKind::centric}) {
      const TileGrid grid = grid_of(180.0, 1, projection, latitude);
      Draw draw(3);
      const Filled filled = fill(grid, mars, draw, 1);
      for (int i = 0; i < 50; ++i) {
        const double lat = some_row(draw);
        const double lon = some_lon(draw, grid);
        double tangent_angle = lat * M_PI / 180.0;
        if (latitude == LatitudeKind::centric) {
          tangent_angle = std::atan2(mars.one_minus_e2() * std::sin(tangent_angle), std::cos(tangent_angle));
        }
        const double row =
            projection == Projection::equal_area ? 90.0 * std::sin(tangent_angle) : tangent_angle * 180.0 / M_PI;
        // A pixel is up to 20 km high and 4.5° wide: 1e-11 degrees of rounding are below a micrometre.
        constexpr double kRounding_m = 1e-6;
        EXPECT_NEAR(filled.field.height_m(Angle::degrees(lat), Angle::degrees(lon)),
                    Reference(grid, filled.there).height_m(row, lon), kRounding_m);
      }
    }
  }
}

TEST(HeightField, ExaggerationScalesHeightsAndRanges) {
  const TileGrid grid = grid_of(180.0, 1);
  Draw draw(1);
  const Filled filled = fill(grid, kEarth, draw, 1);
  const Angle lat = Angle::degrees(12.0);
  const Angle lon = Angle::degrees(34.0);
  EXPECT_DOUBLE_EQ(filled.field.height_m(lat, lon, 20.0), 20.0 * filled.field.height_m(lat, lon));
  EXPECT_EQ(filled.field.height_m(lat, lon, 0.0), 0.0);
  const GeoRect box{lon, lat, Angle::degrees(36.0), Angle::degrees(15.0)};
  const GroundRange once = filled.field.range_m(box);
  const GroundRange upside_down = filled.field.range_m(box, -2.0);
  EXPECT_EQ(upside_down.min_m, -2.0 * once.max_m);
  EXPECT_EQ(upside_down.max_m, -2.0 * once.min_m);
}

TEST(HeightField, NothingIsThereAndGoneAgain) {
  const TileGrid grid = grid_of(180.0, 2);
  HeightField field(kEarth, grid);
  EXPECT_EQ(field.height_at_row_m(10.0, 10.0), 0.0);
  EXPECT_EQ(field.range_m(GeoRect{}).min_m, 0.0);
  EXPECT_EQ(field.range_m(GeoRect{}).max_m, 0.0);
  const TileId fine{.level = 2, .x = 4, .y = 1};
  field.add(tile_at(grid, {.level = 0, .x = 1, .y = 0}));
  const double coarse_m = field.height_at_row_m(10.0, 10.0);
  const std::uint64_t before = field.version();
  field.add(tile_at(grid, fine));
  EXPECT_NE(field.version(), before);
  EXPECT_TRUE(field.has(fine));
  EXPECT_NE(field.height_at_row_m(10.0, 10.0), coarse_m);
  field.add(tile_at(grid, fine));
  EXPECT_EQ(field.size(), 2U);
  field.remove(fine);
  field.remove(fine);
  EXPECT_EQ(field.height_at_row_m(10.0, 10.0), coarse_m);
  EXPECT_EQ(field.size(), 1U);
  EXPECT_EQ(field.height_at_row_m(std::nan(""), 10.0), 0.0);
  EXPECT_EQ(field.height_at_row_m(10.0, std::nan("")), 0.0);
  EXPECT_EQ(field.height_at_row_m(10.0, 10.0 + 720.0), coarse_m);
}

/// The bounds of small patches must come from the few pixels around them, not from a continent.
TEST(HeightField, RangesOfSmallBoxesAreThoseOfTheirBlocks) {
  const TileGrid grid = grid_of(180.0, 2);
  HeightField field(kEarth, grid);
  for (int level = 0; level <= 2; ++level) {
    for (const TileId& id : tiles_of(grid, level)) {
      HeightTile tile = tile_at(grid, id);
      for (std::size_t i = 0; i < tile.heights_m.size(); ++i) {
        const std::size_t row_in_tile = i / kTile_px;
        const double row = static_cast<double>(id.y) * kTile_px + static_cast<double>(row_in_tile) + 0.5;
        tile.heights_m[i] = static_cast<float>(row * tile_span_deg(grid, level) / kTile_px);  // degrees from the pole
      }
      field.add(std::move(tile));
    }
  }
  const auto box = [](double lat) {
    return GeoRect{Angle::degrees(10.0), Angle::degrees(lat), Angle::degrees(11.0), Angle::degrees(lat + 1.0)};
  };
  constexpr double kBlocks_deg = 2.0 * 16.0 * 45.0 / kTile_px;  // two blocks of 16 pixels of level 2
  for (const double lat : {-60.0, 0.0, 40.0}) {
    const GroundRange range = field.range_m(box(lat));
    EXPECT_LE(range.max_m - range.min_m, kBlocks_deg) << lat;
    EXPECT_LE(range.min_m, 90.0 - lat - 1.0);
    EXPECT_GE(range.max_m, 90.0 - lat);
  }
}

TEST(HeightField, RangesOfPatchesHoldTheHeightsOfTheirVertices) {
  const TileGrid imagery = grid_of(288.0, 3, Projection::equal_area);
  PatchTree tree(kEarth, imagery, 8);
  Draw draw(8);
  const Filled filled = fill(grid_of(180.0, 3), kEarth, draw, 2);
  for (int face = 0; face < kCubeFaces; ++face) {
    PatchNode* node = &tree.root(static_cast<CubeFace>(face));
    for (int depth = 0; depth < 5; ++depth) {
      const GroundRange range = filled.field.range_m(tree, *node, 3.0);
      for (int i = 0; i <= 8; ++i) {
        for (int j = 0; j <= 8; ++j) {
          const EcefDir normal = patch_point(node->id, i, j, 8);
          const Geodetic place = Ellipsoid::lat_lon(normal);
          const double height_m = filled.field.height_m(place.lat, place.lon, 3.0);
          ASSERT_GE(height_m, range.min_m - kSum_m) << face << " " << depth;
          ASSERT_LE(height_m, range.max_m + kSum_m) << face << " " << depth;
        }
      }
      tree.ensure_children(*node);
      node = node->children[static_cast<std::size_t>(draw.whole(0, 3))];
    }
  }
}

}  // namespace
}  // namespace terrella
