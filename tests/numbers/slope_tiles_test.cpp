// Slopes of heights, judged by the derivatives of the formula that the heights follow.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "geo/body.h"
#include "raster_files.h"
#include "streaming/numbers/slope_tiles.h"
#include "streaming/warp/warp_source.h"
#include "tiles/height_decoder.h"
#include "tiles/tile_range.h"

namespace terrella::test {
namespace {

// Heights of 100 km and more over whole planets make slopes of degrees.
constexpr double kHigh_m = 3.0e6;
// A texel is up to 1.5 degrees: the second differences of the waves over a texel, and one more where the texels of two
// rows differ in width.
constexpr double kOff_deg = 0.05, kOffBesideOtherRows_deg = 0.6;

double waves_m(double lat, double lon) { return kHigh_m * std::cos(lat) * std::cos(lat) * std::sin(2.0 * lon); }

double slope_of_waves_deg(const Ellipsoid& figure, double lat, double lon) {
  const double n = figure.prime_vertical_radius_m(std::sin(lat));
  const double m = n * figure.one_minus_e2() / (1.0 - figure.e2() * std::sin(lat) * std::sin(lat));
  const double east = kHigh_m * std::cos(lat) * 2.0 * std::cos(2.0 * lon) / n;
  const double north = -kHigh_m * std::sin(2.0 * lat) * std::sin(2.0 * lon) / m;
  return std::atan(std::hypot(east, north)) * 180.0 / M_PI;
}

class Waves : public TileSource {
 public:
  explicit Waves(const TileGrid& grid, double unit_m = 1.0) : unit_m_(unit_m) {
    info_.grid = grid;
    info_.numbers = NumberInfo{.scale = 0.5, .offset = 20.0, .floats = true, .unit = unit_m == 1.0 ? "m" : "km"};
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  TileSetInfo& info() { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside"};
    EncodedTile tile;
    tile.make_numbers = [this, id]() -> Result<Numbers, TileFailure> {
      const int px = info_.grid.tile_px;
      Numbers numbers{px, px, {}};
      for (int row = 0; row < px; ++row) {
        for (int column = 0; column < px; ++column) {
          const auto [lat, lon] = place(info_.grid, id, column, row);
          numbers.values.push_back(static_cast<float>((waves_m(lat, lon) / unit_m_ - 20.0) / 0.5));
        }
      }
      return numbers;
    };
    return tile;
  }
  struct Place {
    double lat, lon;  ///< radians
  };
  static Place place(const TileGrid& grid, const TileId& id, int column, int row) {
    const double texel = tile_span_deg(grid, id.level) / grid.tile_px;
    const double lon =
        grid.west_deg + std::ldexp(static_cast<double>(id.x) * grid.tile_px + column + 0.5, id.squeeze) * texel;
    const double row_deg = grid.north_deg - (static_cast<double>(id.y) * grid.tile_px + row + 0.5) * texel;
    return {latitude_of_row(grid, earth().ellipsoid, row_deg).rad(), lon * M_PI / 180.0};
  }

 private:
  TileSetInfo info_;
  double unit_m_;
};

std::shared_ptr<TileSource> slopes(std::shared_ptr<TileSource> heights) {
  auto made = slope_tiles(std::move(heights), GroundAngle::slope, earth().ellipsoid, "waves");
  EXPECT_TRUE(made) << (made ? "" : made.error().message);
  return made ? *made : nullptr;
}

void expect_slopes(const TileGrid& grid, int level, double unit_m = 1.0, double most_lat_deg = 90.0) {
  const auto made = slopes(std::make_shared<Waves>(grid, unit_m));
  ASSERT_NE(made, nullptr);
  EXPECT_EQ(made->info().numbers->unit, "°");
  double most = 0.0, most_beside = 0.0, steepest = 0.0;
  for_each_place(grid, level, [&](const TileId& id) {
    const auto tile = made->read(id);
    EXPECT_TRUE(tile);
    const auto numbers = decode_numbers(*tile, *made->info().numbers, grid.tile_px);
    EXPECT_TRUE(numbers);
    for (int row = 0; row < grid.tile_px; ++row) {
      const std::int64_t from_top = id.y * grid.tile_px + row, last = rows(grid, level) * grid.tile_px - 1;
      if (from_top == 0 || from_top == last) continue;  // there is no row beyond a pole
      const auto above = squeeze_of_row(grid, level, (from_top - 1) / grid.tile_px),
                 below = squeeze_of_row(grid, level, (from_top + 1) / grid.tile_px);
      const bool beside = above != id.squeeze || below != id.squeeze;
      for (int column = 0; column < grid.tile_px; ++column) {
        const auto [lat, lon] = Waves::place(grid, id, column, row);
        if (std::abs(lat) > most_lat_deg * M_PI / 180.0) continue;
        const double wanted = slope_of_waves_deg(earth().ellipsoid, lat, lon);
        const double off =
            std::abs(double{numbers->values[static_cast<std::size_t>(row * grid.tile_px + column)]} - wanted);
        (beside ? most_beside : most) = std::max(beside ? most_beside : most, off);
        steepest = std::max(steepest, wanted);
      }
    }
    return true;
  });
  EXPECT_LT(most, kOff_deg);
  EXPECT_LT(most_beside, kOffBesideOtherRows_deg);
  EXPECT_GT(steepest, 20.0);
}

TEST(SlopeTiles, EqualTheDerivativesOverThePlanet) {
  expect_slopes({.tile_px = 64, .max_level = 2}, 2);
  expect_slopes({.tile_px = 64, .max_level = 2}, 2, 1000.0);
  expect_slopes({.tile_px = 64, .max_level = 2, .projection = Projection::equal_area}, 2, 1.0,
                75.0);  // rows of degrees at a pole
}

TEST(SlopeTiles, EqualThemWhereRowsAreSqueezed) {
  const TileGrid grid{.tile_px = 32, .max_level = 4, .reduced = true};
  ASSERT_GT(squeeze_of_row(grid, 4, 0), 0);
  expect_slopes(grid, 4);
}

/// gdaldem's angles of hills, and this library's, pixel by pixel. gdaldem reads a copy whose pixels have the metres
/// that they have at the hills' latitude.
struct HillCase {
  const char* mode;
  GroundAngle angle;
  double lat_deg;
};

void PrintTo(const HillCase& one, std::ostream* out) { *out << one.mode << " at " << one.lat_deg << " degrees"; }

class HillsBesideGdaldem : public testing::TestWithParam<HillCase> {
 protected:
  static constexpr int kAcross = 200, kDown = 150;
  static constexpr double kWest_deg = 10.0, kStep_deg = 0.001;
  static constexpr double kLeastSlope_deg = 1.0;  // level ground faces anywhere
  static constexpr double kRounding_deg = 0.01;   // heights and angles as floats
  /// The change of an angle by that of a degree of longitude, in metres, from the raster's middle to its edge.
  [[nodiscard]] static double of_latitude_deg() {
    return 0.5 * std::tan(std::abs(GetParam().lat_deg) * M_PI / 180.0) * 0.5 * kDown * kStep_deg;
  }

  static double hill_m(int x, int y) { return 900.0 * std::sin(x / 9.0) * std::cos(y / 13.0) + 4.0 * x; }
  void SetUp() override {
    const Ellipsoid figure = earth().ellipsoid;
    const double lat = GetParam().lat_deg * M_PI / 180.0, n = figure.prime_vertical_radius_m(std::sin(lat));
    const double m = n * figure.one_minus_e2() / (1.0 - figure.e2() * std::sin(lat) * std::sin(lat));
    const double radians = kStep_deg * M_PI / 180.0;
    top_deg_ = GetParam().lat_deg + 0.5 * kDown * kStep_deg;
    write_raw(folder_.path() / "hills.raw", "Float32", kAcross, kDown, 1,
              [](int x, int y, int) { return hill_m(x, y); });
    ASSERT_TRUE(translate(fmt::format("-a_srs EPSG:4326 -a_ullr {} {} {} {}", kWest_deg, top_deg_,
                                      kWest_deg + kAcross * kStep_deg, top_deg_ - kDown * kStep_deg),
                          folder_.path() / "hills.raw", folder_.path() / "hills.tif"));
    ASSERT_TRUE(translate(
        fmt::format("-a_srs EPSG:32632 -a_ullr 0 0 {} {}", kAcross * radians * n * std::cos(lat), -kDown * radians * m),
        folder_.path() / "hills.raw", folder_.path() / "metres.tif"));
  }
  [[nodiscard]] GdalPixels by_gdaldem(const std::string& mode) const {
    const std::string out = (folder_.path() / (mode + ".tif")).string();
    EXPECT_TRUE(run(fmt::format("{} {} {} {}", TERRELLA_GDALDEM, mode, (folder_.path() / "metres.tif").string(), out)));
    return read_by_gdal(out, 1);
  }

  ScratchFolder folder_;
  double top_deg_ = 0.0;
};

TEST_P(HillsBesideGdaldem, HaveItsAngles) {
  const GdalPixels wanted = by_gdaldem(GetParam().mode), slope = by_gdaldem("slope");
  const CrsPlace place{.to_crs = {kWest_deg, kStep_deg, 0.0, top_deg_, 0.0, -kStep_deg}, .crs = "EPSG:4326"};
  auto opened = open_raster(folder_.path() / "hills.tif", place, {.heights = true, .stored = true});
  ASSERT_TRUE(opened) << opened.error().message;
  auto tiles = warp_source(*std::move(opened), {.figure = {earth().ellipsoid, {}, {}}, .tile_px = 64}, "hills.tif");
  ASSERT_TRUE(tiles) << tiles.error().message;
  const auto made = slope_tiles(*std::move(tiles), GetParam().angle, earth().ellipsoid, "hills.tif");
  ASSERT_TRUE(made) << made.error().message;
  int compared = 0;
  double most = 0.0;
  for (int y = 1; y < kDown - 1; y += 3) {
    for (int x = 1; x < kAcross - 1; x += 3) {
      if (slope.at(x, y, 0) < kLeastSlope_deg) continue;
      const Geodetic at{.lat = Angle::degrees(top_deg_ - (y + 0.5) * kStep_deg),
                        .lon = Angle::degrees(kWest_deg + (x + 0.5) * kStep_deg)};
      const auto value = (*made)->value_at(at, earth().ellipsoid);
      ASSERT_TRUE(value) << value.error().why;
      most = std::max(most, std::abs(std::remainder(*value - wanted.at(x, y, 0), 360.0)));
      ++compared;
    }
  }
  EXPECT_LT(most, of_latitude_deg() + kRounding_deg);
  EXPECT_GT(compared, 2000);
}

// gdaldem's aspect takes pixels for squares, as they are at 6.59 degrees.
INSTANTIATE_TEST_SUITE_P(Modes, HillsBesideGdaldem,
                         testing::Values(HillCase{"slope", GroundAngle::slope, 47.0},
                                         HillCase{"slope", GroundAngle::slope, -70.0},
                                         HillCase{"aspect", GroundAngle::aspect, 6.59}),
                         [](const auto& one) { return one.param.mode + std::to_string(one.index); });

// Ground that rises towards one side faces the other one.
TEST(SlopeTiles, HaveDirectionsToo) {
  const TileGrid grid{.tile_px = 64, .max_level = 2};
  const auto made = slope_tiles(std::make_shared<Waves>(grid), GroundAngle::aspect, earth().ellipsoid, "waves");
  ASSERT_TRUE(made);
  EXPECT_EQ((*made)->info().numbers->period, 360.0);
  for (const double lat_deg : {-50.0, 10.0, 60.0}) {
    for (const double lon_deg : {-170.0, -100.0, 10.0, 80.0, 150.0}) {
      const double lat = lat_deg * M_PI / 180.0, lon = lon_deg * M_PI / 180.0;
      const double east = std::cos(lat) * 2.0 * std::cos(2.0 * lon), north = -std::sin(2.0 * lat) * std::sin(2.0 * lon);
      const double wanted = std::atan2(-east, -north) * 180.0 / M_PI;
      const auto value =
          (*made)->value_at({.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg)}, earth().ellipsoid);
      ASSERT_TRUE(value);
      EXPECT_GE(*value, 0.0);
      EXPECT_LT(*value, 360.0);
      constexpr double kOfATexel_deg = 2.0;
      EXPECT_LT(std::abs(std::remainder(*value - wanted, 360.0)), kOfATexel_deg) << lat_deg << ' ' << lon_deg;
    }
  }
}

TEST(SlopeTiles, GiveTheValueAtAPlace) {
  const auto made = slopes(std::make_shared<Waves>(TileGrid{.tile_px = 64, .max_level = 3}));
  const auto value = made->value_at({.lat = Angle::degrees(40.0), .lon = Angle::degrees(10.0)}, earth().ellipsoid);
  ASSERT_TRUE(value);
  constexpr double kOfATexel_deg = 0.3;  // the place is up to half a texel, 0.18 degrees, from its middle
  EXPECT_NEAR(*value, slope_of_waves_deg(earth().ellipsoid, 40.0 * M_PI / 180.0, 10.0 * M_PI / 180.0), kOfATexel_deg);
}

TEST(SlopeTiles, RefuseWhatIsNoHeight) {
  auto warm = std::make_shared<Waves>(TileGrid{.tile_px = 64});
  warm->info().numbers->unit = "°C";
  const auto of_degrees = slope_tiles(warm, GroundAngle::slope, earth().ellipsoid, "warm.tif");
  ASSERT_FALSE(of_degrees);
  EXPECT_NE(of_degrees.error().message.find("warm.tif"), std::string::npos);
  EXPECT_NE(of_degrees.error().message.find("°C"), std::string::npos);
  auto pictures = std::make_shared<Waves>(TileGrid{.tile_px = 64});
  pictures->info().numbers.reset();
  EXPECT_FALSE(slope_tiles(pictures, GroundAngle::aspect, earth().ellipsoid, "red.png"));
}

}  // namespace
}  // namespace terrella::test
