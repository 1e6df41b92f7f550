// Rasters that show without a cut: which ones do, and how much the first picture reads.
#include <gtest/gtest.h>

#include <cmath>

#include "painted_raster.h"
#include "streaming/warp/direct_tiles.h"
#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

using test::PaintedOptions;
using test::PaintedRaster;

/// A planet of square pixels with overviews by halves.
PaintedOptions planet(std::int64_t width_px, int overviews) {
  const double pixel_deg = 360.0 / static_cast<double>(width_px);
  return {.crs = "+proj=longlat +R=6378137",
          .to_crs = {-180.0, pixel_deg, 0.0, 90.0, 0.0, -pixel_deg},
          .width_px = width_px,
          .height_px = width_px / 2,
          .overviews = overviews,
          .rays = 1};
}

bool shows(std::int64_t width_px, int overviews) {
  return shows_at_once(PaintedRaster(planet(width_px, overviews), {}, {}).info());
}

TEST(Direct, ThreeOverviewsOfALargePictureAreEnough) {
  EXPECT_TRUE(shows(86400, 3)) << "as GDAL makes a COG of a JPEG";
  EXPECT_FALSE(shows(86400, 2)) << "233 megapixels";
  EXPECT_TRUE(shows(5760, 0));
  EXPECT_FALSE(shows(10800, 0)) << "without any overview it is cut";
}

/// Counts its blocks, each of one colour.
class PlainRaster : public RasterSource {
 public:
  PlainRaster(RasterInfo info, std::int64_t& pixels) : info_(std::move(info)), pixels_(pixels) {}
  [[nodiscard]] const RasterInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& block) override {
    const RasterLevel& level = info_.levels[static_cast<std::size_t>(block.level)];
    const int width = level.block_width_px, height = level.block_height_px;
    pixels_ += std::int64_t{width} * height;
    EncodedTile tile;
    tile.make_picture = [=]() -> Result<Image, TileFailure> {
      return Image{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height) * 4, 255)};
    };
    return tile;
  }

 private:
  const RasterInfo info_;
  std::int64_t& pixels_;
};

/// Pixels of the raster that the two root tiles read.
std::int64_t pixels_of_first_picture(const PaintedOptions& options) {
  std::int64_t pixels = 0;
  const WarpOptions warp{.figure = {.ellipsoid = Ellipsoid(6378137.0, 0.0)}, .body = "sphere", .tile_px = 64};
  const auto tiles =
      warp_source(std::make_unique<PlainRaster>(PaintedRaster(options, {}, {}).info(), pixels), warp, "the raster");
  EXPECT_TRUE(tiles);
  for (std::int64_t x = 0; tiles && x < 2; ++x) {
    const auto tile = (*tiles)->read({0, x, 0});
    EXPECT_TRUE(tile && tile->make_picture());
  }
  return pixels;
}

TEST(Direct, TheFirstPictureOfARasterWithOverviewsReadsLittle) {
  constexpr std::int64_t kRootPixels = 2 * 64 * 64;
  EXPECT_EQ(pixels_of_first_picture(planet(1 << 16, 9)), kRootPixels) << "an overview is the picture itself";
  // Pixels off the grid are resampled: the root tile has 360 degrees, and an overview twice as fine has the same
  // pixels.
  PaintedOptions beside = planet(1 << 16, 9);
  beside.to_crs.x_per_column *= 0.999;
  EXPECT_EQ(pixels_of_first_picture(beside), kRootPixels);
}

}  // namespace
}  // namespace terrella
