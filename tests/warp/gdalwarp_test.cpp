// Tiles beside gdalwarp's of the same raster: no farther from the truth, a function of the place met by 64 rays a
// pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "painted_raster.h"
#include "streaming/warp/warp_source.h"
#include "tests/support/scratch_folder.h"

namespace terrella {
namespace {

/// Rounding to bytes alone leaves 0.29 levels; two roundings differ by less than this.
constexpr double kRounding = 0.03;
constexpr int kRays = 8;

struct Warped {
  const char* name;
  test::PaintedOptions raster;
  double lat_deg, lon_deg;
  int coarser;
  /// Longitudes and latitudes on the raster's own body.
  [[nodiscard]] std::string degrees() const {
    return raster.crs.find("WGS84") != std::string::npos ? "EPSG:4326" : "+proj=longlat +R=6378137 +no_defs";
  }
};
void PrintTo(const Warped& given, std::ostream* out) { *out << given.name; }

/// Waves of several directions and lengths, from five pixels of `pixel_deg` on.
double waves_at(double lat, double lon, double pixel_deg, double cosine) {
  double sum = 127.5;
  int k = 0;
  for (const double length : {5.0, 7.0, 11.0, 19.0}) {
    const double turn = 0.7 + 1.3 * k++;
    const double along = lat * std::cos(turn) + lon * cosine * std::sin(turn);
    sum += 28.0 * std::sin(2.0 * std::numbers::pi * along / (length * pixel_deg));
  }
  return sum;
}

class BesideGdalwarp : public testing::TestWithParam<Warped> {
 protected:
  [[nodiscard]] bool run(const std::string& command) const {
    return std::system(("cd '" + (folder_ / "").string() + "' && " + command + " >log.txt 2>&1").c_str()) == 0;
  }
  /// Writes the finest level for GDAL.
  [[nodiscard]] bool write_raster(test::PaintedRaster& raster, const test::PaintedOptions& options) const {
    const auto width = static_cast<int>(options.width_px), height = static_cast<int>(options.height_px);
    std::ofstream file(folder_ / "raster.ppm", std::ios::binary);
    file << "P6\n" << width << " " << height << "\n255\n";
    const TileId whole{.level = static_cast<int>(raster.info().levels.size()) - 1};
    const Image image = *raster.read(whole)->make_picture();
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        file.write(reinterpret_cast<const char*>(&image.rgba[4 * static_cast<std::size_t>(y * image.width_px + x)]), 3);
      }
    }
    file.close();
    const CrsPoint lower = options.to_crs.at(width, height);
    return run(std::string(GDAL_TRANSLATE) + " -q -a_srs '" + options.crs + "' -a_ullr " +
               std::to_string(options.to_crs.x0) + " " + std::to_string(options.to_crs.y0) + " " +
               std::to_string(lower.x) + " " + std::to_string(lower.y) + " raster.ppm raster.tif");
  }
  test::ScratchFolder folder_;
};

TEST_P(BesideGdalwarp, TilesAreNoFartherFromTheTruth) {
  const Warped& given = GetParam();
  const WarpOptions options{.figure = {.ellipsoid = Ellipsoid(6378137.0, 0.0)}, .body = "sphere", .tile_px = 128};
  const auto grid = warp_grid(test::PaintedRaster(given.raster, {}, {}).info(), options, "the raster");
  ASSERT_TRUE(grid) << grid.error().message;
  const int level = grid->max_level - given.coarser;
  const TileXY xy = tile_xy(*grid, level, given.lat_deg, given.lon_deg);
  const TileId id{level, static_cast<std::int64_t>(xy.x), static_cast<std::int64_t>(xy.y)};
  const TileBounds bounds = tile_bounds(*grid, id);
  const double step = tile_span_deg(*grid, level) / grid->tile_px;
  const double cosine = std::cos(given.lat_deg * std::numbers::pi / 180.0);
  const auto ground = [&](double lat, double lon) { return waves_at(lat, lon, step, cosine); };

  auto raster = std::make_unique<test::PaintedRaster>(given.raster, ground, ground);
  auto one_block = given.raster;
  one_block.block_px = static_cast<int>(std::max(one_block.width_px, one_block.height_px));
  one_block.overviews = 0;
  test::PaintedRaster whole(one_block, ground, ground);
  ASSERT_TRUE(write_raster(whole, given.raster));
  char target[256];
  std::snprintf(target, sizeof(target), " -te %.12f %.12f %.12f %.12f -ts %d %d", bounds.west_deg, bounds.south_deg,
                bounds.east_deg, bounds.north_deg, grid->tile_px, grid->tile_px);
  ASSERT_TRUE(run(std::string(GDALWARP) + " -q -r cubic -et 0 -of ENVI -t_srs '" + given.degrees() + "'" + target +
                  " raster.tif warped.img"));
  std::ifstream file(folder_ / "warped.img", std::ios::binary);
  std::vector<unsigned char> theirs(static_cast<std::size_t>(grid->tile_px) * grid->tile_px);
  file.read(reinterpret_cast<char*>(theirs.data()), static_cast<std::streamsize>(theirs.size()));
  ASSERT_TRUE(file);

  const auto tiles = warp_source(std::move(raster), options, "the raster");
  ASSERT_TRUE(tiles) << tiles.error().message;
  const auto ours = (*tiles)->read(id)->make_picture();
  ASSERT_TRUE(ours) << ours.error().why;
  double our_error = 0.0, their_error = 0.0;
  int pixels = 0;
  for (int y = 0; y < grid->tile_px; ++y) {
    for (int x = 0; x < grid->tile_px; ++x) {
      const auto at = static_cast<std::size_t>(y * grid->tile_px + x);
      if (ours->rgba[4 * at + 3] < 255 || theirs[at] == 0) continue;
      double truth = 0.0;
      for (int ray = 0; ray < kRays * kRays; ++ray) {
        truth += ground(bounds.north_deg - (y + (ray / kRays + 0.5) / kRays) * step,
                        bounds.west_deg + (x + (ray % kRays + 0.5) / kRays) * step);
      }
      truth /= kRays * kRays;
      our_error += (ours->rgba[4 * at] - truth) * (ours->rgba[4 * at] - truth);
      their_error += (theirs[at] - truth) * (theirs[at] - truth);
      ++pixels;
    }
  }
  ASSERT_GT(pixels, 2000);
  RecordProperty("ours", std::to_string(std::sqrt(our_error / pixels)));
  RecordProperty("gdalwarp", std::to_string(std::sqrt(their_error / pixels)));
  EXPECT_LE(std::sqrt(our_error / pixels), std::sqrt(their_error / pixels) + kRounding);
  if (std::getenv("WARP_SHOW_RMS") != nullptr) {
    std::printf("%s: %.3f, gdalwarp %.3f\n", given.name, std::sqrt(our_error / pixels),
                std::sqrt(their_error / pixels));
  }
}

constexpr double kDegree = 6378137.0 * std::numbers::pi / 180.0;

test::PaintedOptions square(const char* crs, double west, double north, double pixel, int side) {
  return {.crs = crs,
          .to_crs = {west, pixel, 0.0, north, 0.0, -pixel},
          .width_px = side,
          .height_px = side,
          .overviews = 3,
          .rays = 8};
}
const auto kSinusoidal = square("+proj=sinu +lon_0=30 +R=6378137", -20 * kDegree, 60 * kDegree, 0.1 * kDegree, 400);
const auto kStereographic = square("+proj=stere +lat_0=90 +R=6378137", -2e6, 2e6, 10000.0, 400);
const auto kUtm = square("+proj=utm +zone=32 +datum=WGS84", 300000.0, 5200000.0, 1000.0, 400);
const auto kLambert =
    square("+proj=lcc +lat_1=33 +lat_2=45 +lat_0=39 +lon_0=-96 +R=6378137", -2e6, 1.5e6, 10000.0, 400);

INSTANTIATE_TEST_SUITE_P(Everywhere, BesideGdalwarp,
                         testing::Values(Warped{"sinusoidal", kSinusoidal, 40.0, 40.0, 0},
                                         Warped{"sinusoidal_overview", kSinusoidal, 40.0, 30.0, 1},
                                         Warped{"stereographic", kStereographic, 80.0, 45.0, 0},
                                         Warped{"stereographic_overview", kStereographic, 78.0, 10.0, 1},
                                         Warped{"utm", kUtm, 45.0, 9.0, 0}, Warped{"utm_overview", kUtm, 45.0, 9.0, 1},
                                         Warped{"lambert", kLambert, 40.0, -105.0, 0},
                                         Warped{"lambert_overview", kLambert, 40.0, -100.0, 1}),
                         [](const auto& given) { return std::string(given.param.name); });

}  // namespace
}  // namespace terrella
