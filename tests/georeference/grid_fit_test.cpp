#include "streaming/georeference/grid_fit.h"

#include <gtest/gtest.h>

namespace terrella::test {
namespace {

FittedPlace fit(std::int64_t width, std::int64_t height, double west, double north, double pixel_width,
                double pixel_height = 0.0) {
  const PictureFile picture{.path = {}, .width_px = width, .height_px = height};
  return fit_to_grid(picture, {.west_deg = west,
                               .north_deg = north,
                               .pixel_width_deg = pixel_width,
                               .pixel_height_deg = pixel_height == 0.0 ? pixel_width : pixel_height});
}

TEST(GridFitTest, WholePlanetsFromAnyColumn) {
  for (const double west : {-180.0, -180.0 + 1e-9, 180.0, -540.0}) {
    const FittedPlace planet = fit(360, 180, west, 90.0, 1.0);
    EXPECT_EQ(planet.fit, GridFit::as_it_is) << west;
    EXPECT_TRUE(planet.whole_planet) << west;
  }
  for (const auto& [west, column] : {std::pair(0.0, 180), std::pair(-179.0, 1), std::pair(179.0, 359),
                                     std::pair(360.0, 180), std::pair(0.005, 180)}) {
    const FittedPlace planet = fit(360, 180, west, 90.0, 1.0);
    EXPECT_EQ(planet.fit, GridFit::rolled) << west;
    EXPECT_EQ(planet.first_column, column) << west;
    EXPECT_TRUE(planet.whole_planet) << west;
  }
  EXPECT_EQ(fit(360, 180, 0.02, 90.0, 1.0).fit, GridFit::none);
}

TEST(GridFitTest, WholePlanetsOfOddWidth) {
  // 11469 / 2 is no whole number of rows: GDAL's pixels are not quite square then.
  const FittedPlace planet = fit(11469, 5734, -180.0, 90.0, 360.0 / 11469, 180.0 / 5734);
  EXPECT_EQ(planet.fit, GridFit::as_it_is);
  EXPECT_TRUE(planet.whole_planet);
  EXPECT_EQ(fit(11469, 5733, -180.0, 90.0, 360.0 / 11469, 180.0 / 5733).fit, GridFit::none);
}

TEST(GridFitTest, Parts) {
  const FittedPlace part = fit(40, 20, 10.0, 50.0, 0.25);
  EXPECT_EQ(part.fit, GridFit::as_it_is);
  EXPECT_FALSE(part.whole_planet);
  EXPECT_DOUBLE_EQ(part.bounds.east.deg(), 20.0);
  EXPECT_DOUBLE_EQ(part.bounds.south.deg(), 45.0);
  const FittedPlace crossing = fit(40, 20, 175.0, 50.0, 0.25);
  EXPECT_EQ(crossing.fit, GridFit::as_it_is);
  EXPECT_NEAR(crossing.bounds.east.deg(), -175.0, 1e-9);  // rounding of degrees to radians
  // 360° is not a whole number of these pixels: they fit, as long as they do not cross ±180°.
  EXPECT_EQ(fit(40, 20, -180.0 + 100 * 0.247, 90.0 - 100 * 0.247, 0.247).fit, GridFit::as_it_is);
  EXPECT_EQ(fit(40, 20, -180.0 + 1440 * 0.247, 90.0 - 100 * 0.247, 0.247).fit, GridFit::none);
}

TEST(GridFitTest, AGridMayBeginBesideThePlanetsCorner) {
  const FittedPlace part = fit(40, 20, 10.125, 50.0625, 0.25);
  EXPECT_EQ(part.fit, GridFit::as_it_is);
  EXPECT_DOUBLE_EQ(part.bounds.west.deg(), 10.125);
  EXPECT_DOUBLE_EQ(part.bounds.north.deg(), 50.0625);
  // Columns beyond ±180° must be those from -180° on.
  EXPECT_EQ(fit(40, 20, 175.125, 50.0, 0.25).fit, GridFit::none);
}

TEST(GridFitTest, BandsRoundThePlanet) {
  const FittedPlace band = fit(360, 60, 0.0, 30.0, 1.0);
  EXPECT_EQ(band.fit, GridFit::rolled);
  EXPECT_FALSE(band.whole_planet);
  EXPECT_EQ(band.bounds.west.deg(), -180.0);
  EXPECT_EQ(band.bounds.east.deg(), 180.0);
  EXPECT_EQ(band.bounds.south.deg(), -30.0);
}

TEST(GridFitTest, PixelsThatAreNotTheGrids) {
  EXPECT_EQ(fit(40, 20, 10.0, 50.0, 0.25, 0.2).fit, GridFit::none);
  EXPECT_EQ(fit(361, 180, -180.0, 90.0, 1.0).fit, GridFit::none);  // more than a turn
  EXPECT_EQ(fit(360, 181, -180.0, 90.0, 1.0).fit, GridFit::none);  // beyond the south pole
  EXPECT_EQ(fit(360, 180, -180.0, 91.0, 1.0).fit, GridFit::none);  // beyond the north pole
  EXPECT_EQ(fit(361, 181, -180.5, 90.5, 1.0).fit, GridFit::none);  // by nodes
}

}  // namespace
}  // namespace terrella::test
