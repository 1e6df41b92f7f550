// Tiles beside gdalwarp's of the same raster: in the same place, and no farther from the truth, a function of the place
// met by 64 rays a pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <optional>

#include "painted_raster.h"
#include "streaming/warp/warp_source.h"
#include "tests/support/scratch_folder.h"

namespace terrella {
namespace {

/// Two programs round a few of the 16384 pixels differently. That moves the root mean square error by half of this,
/// with a probability of a third.
constexpr double kByChance = 0.003;
/// Pixels of the tile; the tiles are no finer than the rasters.
constexpr double kSamePlace_px = 0.05;
/// The same of the finest tiles. The map is true to 0.001 pixels of the raster, up to 0.006 of a tile at 80°.
constexpr double kSameFinePlace_px = 0.006;
constexpr int kRays = 8;
constexpr int kTile_px = 128;

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

/// Waves through the body in several directions, from five pixels of `pixel_deg` on: as long on the ground everywhere.
double waves_at(double lat, double lon, double pixel_deg) {
  const double north = lat * std::numbers::pi / 180.0, east = lon * std::numbers::pi / 180.0;
  const double x = std::cos(north) * std::cos(east), y = std::cos(north) * std::sin(east), z = std::sin(north);
  const double pixel = pixel_deg * std::numbers::pi / 180.0;
  return 127.5 + 28.0 * (std::sin(2.0 * std::numbers::pi * (0.6 * x + 0.8 * y) / (5.0 * pixel)) +
                         std::sin(2.0 * std::numbers::pi * (0.8 * y - 0.6 * z) / (7.0 * pixel)) +
                         std::sin(2.0 * std::numbers::pi * (0.8 * x + 0.6 * z) / (11.0 * pixel)) +
                         std::sin(2.0 * std::numbers::pi * (0.6 * x - 0.8 * y) / (19.0 * pixel)));
}

/// A tile, and the truth of its pixels.
struct Target {
  TileGrid grid;
  TileId id;
  [[nodiscard]] double step_deg() const { return tile_span_deg(grid, id.level) / grid.tile_px; }
  [[nodiscard]] double truth(int x, int y, const test::Ground& ground) const {
    const TileBounds bounds = tile_bounds(grid, id);
    double sum = 0.0;
    for (int ray = 0; ray < kRays * kRays; ++ray) {
      sum += ground(bounds.north_deg - (y + (ray / kRays + 0.5) / kRays) * step_deg(),
                    bounds.west_deg + (x + (ray % kRays + 0.5) / kRays) * step_deg());
    }
    return sum / (kRays * kRays);
  }
};

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
               std::to_string(lower.x) + " " + std::to_string(lower.y) + " raster.ppm raster.tif") &&
           run(std::string(GDALADDO) + " -q -r average raster.tif 2 4 8");
  }
  [[nodiscard]] std::vector<unsigned char> warp(const std::string& overview) const;
  /// Makes the tile by both programs.
  void make();
  void expect_same_place();
  void expect_as_near_the_truth();
  /// Displacement of our content from gdalwarp's in a quarter of the tile, by least squares along the slopes of the
  /// ground. None if the raster does not cover most of the quarter.
  [[nodiscard]] std::optional<CrsPoint> displacement(int x0, int y0) const;

  Target target;
  test::Ground ground;
  std::vector<unsigned char> fine;  ///< gdalwarp's, of the finest level
  Image ours;
  test::ScratchFolder folder_;
};

Target target_of(const Warped& given, const WarpOptions& options) {
  const auto grid = *warp_grid(test::PaintedRaster(given.raster, {}, {}).info(), options, "the raster");
  const int level = grid.max_level - given.coarser;
  const TileXY xy = tile_xy(grid, level, given.lat_deg, given.lon_deg);
  return {grid, {level, static_cast<std::int64_t>(xy.x), static_cast<std::int64_t>(xy.y)}};
}

/// Red of gdalwarp's pixels; empty if it fails. `overview`: NONE, or its number.
std::vector<unsigned char> BesideGdalwarp::warp(const std::string& overview) const {
  const TileBounds bounds = tile_bounds(target.grid, target.id);
  char area[256];
  std::snprintf(area, sizeof(area), " -te %.12f %.12f %.12f %.12f -ts %d %d", bounds.west_deg, bounds.south_deg,
                bounds.east_deg, bounds.north_deg, target.grid.tile_px, target.grid.tile_px);
  if (!run(std::string(GDALWARP) + " -q -overwrite -r cubic -et 0 -of ENVI -ovr " + overview + " -t_srs '" +
           GetParam().degrees() + "'" + area + " raster.tif warped.img")) {
    return {};
  }
  std::ifstream file(folder_ / "warped.img", std::ios::binary);
  std::vector<unsigned char> red(static_cast<std::size_t>(target.grid.tile_px) * target.grid.tile_px);
  file.read(reinterpret_cast<char*>(red.data()), static_cast<std::streamsize>(red.size()));
  return red;
}

std::optional<CrsPoint> BesideGdalwarp::displacement(int x0, int y0) const {
  const TileBounds bounds = tile_bounds(target.grid, target.id);
  const double step = target.step_deg();
  double xx = 0.0, xy = 0.0, yy = 0.0, xd = 0.0, yd = 0.0;
  int pixels = 0;
  for (int y = y0; y < y0 + kTile_px / 2; ++y) {
    for (int x = x0; x < x0 + kTile_px / 2; ++x) {
      const auto at = static_cast<std::size_t>(y * target.grid.tile_px + x);
      if (ours.rgba[4 * at + 3] < 255 || fine[at] == 0) continue;
      const double lat = bounds.north_deg - (y + 0.5) * step, lon = bounds.west_deg + (x + 0.5) * step;
      const double by_x = ground(lat, lon + 0.5 * step) - ground(lat, lon - 0.5 * step);
      const double by_y = ground(lat - 0.5 * step, lon) - ground(lat + 0.5 * step, lon);
      const double difference = ours.rgba[4 * at] - static_cast<double>(fine[at]);
      xx += by_x * by_x;
      xy += by_x * by_y;
      yy += by_y * by_y;
      xd += by_x * difference;
      yd += by_y * difference;
      ++pixels;
    }
  }
  const double det = xx * yy - xy * xy;
  if (pixels < kTile_px * kTile_px / 8) return std::nullopt;
  return CrsPoint{(yy * xd - xy * yd) / det, (xx * yd - xy * xd) / det};
}

void BesideGdalwarp::make() {
  const Warped& given = GetParam();
  const WarpOptions options{.figure = {.ellipsoid = Ellipsoid(6378137.0, 0.0)}, .body = "sphere", .tile_px = kTile_px};
  target = target_of(given, options);
  ground = [step = target.step_deg()](double lat, double lon) { return waves_at(lat, lon, step); };
  auto one_block = given.raster;
  one_block.block_px = static_cast<int>(std::max(one_block.width_px, one_block.height_px));
  one_block.overviews = 0;
  test::PaintedRaster whole(one_block, ground, ground);
  ASSERT_TRUE(write_raster(whole, given.raster));
  fine = warp("NONE");
  ASSERT_FALSE(fine.empty());
  const auto tiles = warp_source(std::make_unique<test::PaintedRaster>(given.raster, ground, ground), options, "it");
  ASSERT_TRUE(tiles) << tiles.error().message;
  auto made = (*tiles)->read(target.id)->make_picture();
  ASSERT_TRUE(made) << made.error().why;
  ours = *std::move(made);
}

void BesideGdalwarp::expect_same_place() {
  double most = 0.0;
  const double limit = GetParam().coarser == 0 ? kSameFinePlace_px : kSamePlace_px;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const auto moved = displacement(kTile_px / 2 * (quarter % 2), kTile_px / 2 * (quarter / 2));
    if (!moved) continue;
    EXPECT_LE(std::hypot(moved->x, moved->y), limit) << "quarter " << quarter;
    most = std::max(most, std::hypot(moved->x, moved->y));
  }
  EXPECT_GT(most, 0.0) << "nothing was compared";
  RecordProperty("displacement", std::to_string(most));
}

void BesideGdalwarp::expect_as_near_the_truth() {
  const Warped& given = GetParam();
  // A level of the tile's resolution is not far from an overview's. gdalwarp may take either, and so may the tiles.
  const auto coarse = given.coarser == 0 ? fine : warp(std::to_string(given.coarser - 1));
  ASSERT_FALSE(coarse.empty());
  double our_error = 0.0, fine_error = 0.0, coarse_error = 0.0;
  int pixels = 0;
  for (std::size_t at = 0; at < fine.size(); ++at) {
    if (ours.rgba[4 * at + 3] < 255 || fine[at] == 0 || coarse[at] == 0) continue;
    const double truth = target.truth(static_cast<int>(at) % kTile_px, static_cast<int>(at) / kTile_px, ground);
    our_error += (ours.rgba[4 * at] - truth) * (ours.rgba[4 * at] - truth);
    fine_error += (fine[at] - truth) * (fine[at] - truth);
    coarse_error += (coarse[at] - truth) * (coarse[at] - truth);
    ++pixels;
  }
  ASSERT_GT(pixels, kTile_px * kTile_px / 4);
  const double most = std::sqrt(std::max(fine_error, coarse_error) / pixels);
  RecordProperty("ours", std::to_string(std::sqrt(our_error / pixels)));
  RecordProperty("gdalwarp", std::to_string(most));
  RecordProperty("gdalwarp_finest", std::to_string(std::sqrt(fine_error / pixels)));
  RecordProperty("gdalwarp_overview", std::to_string(std::sqrt(coarse_error / pixels)));
  EXPECT_LE(std::sqrt(our_error / pixels), most + kByChance);
}

TEST_P(BesideGdalwarp, TilesShowThingsInTheSamePlaceAndNoFartherFromTheTruth) {
  ASSERT_NO_FATAL_FAILURE(make());
  expect_same_place();
  expect_as_near_the_truth();
}

constexpr double kDegree = 6378137.0 * std::numbers::pi / 180.0;

test::PaintedOptions square(const char* crs, double west, double north, double pixel, int side) {
  return {.crs = crs,
          .to_crs = {west, pixel, 0.0, north, 0.0, -pixel},
          .width_px = side,
          .height_px = side,
          .overviews = 3,
          .rays = 4};
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
