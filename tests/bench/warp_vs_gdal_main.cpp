// The time of all finest tiles of a raster, beside gdalwarp's for the same pixels, and the memory of a large raster.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

constexpr int kBlockPx = 256;
constexpr double kHalf_m = 6378137.0 * 3.14159265358979323846;

/// A sinusoidal raster of a whole planet; its rough blocks are made as they are read.
class RoughRaster : public RasterSource {
 public:
  explicit RoughRaster(std::int64_t width, std::int64_t height) {
    const double pixel_m = 2.0 * kHalf_m / static_cast<double>(width);
    info_.crs = "+proj=sinu +R=6378137 +no_defs +type=crs";
    info_.levels = {{.width_px = width,
                     .height_px = height,
                     .block_width_px = kBlockPx,
                     .block_height_px = kBlockPx,
                     .to_crs = {-kHalf_m, pixel_m, 0.0, 0.5 * kHalf_m, 0.0, -pixel_m}}};
  }
  [[nodiscard]] const RasterInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    EncodedTile tile;
    tile.make_picture = [id]() -> Result<Image, TileFailure> { return block(id); };
    return tile;
  }
  static Image block(const TileId& id) {
    Image image{kBlockPx, kBlockPx, std::vector<std::uint8_t>(std::size_t{4} * kBlockPx * kBlockPx)};
    auto noise = static_cast<unsigned>(id.x * 7919 + id.y * 104729 + 1);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      noise = noise * 1664525U + 1013904223U;
      const auto level = static_cast<std::uint8_t>(96U + (noise >> 26U));
      image.rgba[i] = level;
      image.rgba[i + 1] = level / 2;
      image.rgba[i + 2] = 90;
      image.rgba[i + 3] = 255;
    }
    return image;
  }

 private:
  RasterInfo info_;
};

double cpu_seconds(int who) {
  rusage usage{};
  getrusage(who, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

double own_seconds(TileSource& tiles, int level, std::int64_t most) {
  const double before = cpu_seconds(RUSAGE_SELF);
  const TileGrid& grid = tiles.info().grid;
  for (std::int64_t y = 0; y < rows(grid, level); ++y) {
    for (std::int64_t x = 0; x < columns(grid, level) && most > 0; ++x, --most) {
      const auto tile = tiles.read({level, x, y});
      if (tile && !tile->make_picture()) return 0.0;
    }
  }
  return cpu_seconds(RUSAGE_SELF) - before;
}

bool write_for_gdal(const std::filesystem::path& folder, std::int64_t width, std::int64_t height) {
  std::ofstream file(folder / "raster.ppm", std::ios::binary);
  file << "P6\n" << width << " " << height << "\n255\n";
  std::vector<Image> blocks(static_cast<std::size_t>(width / kBlockPx));
  for (std::int64_t y = 0; y < height; ++y) {
    for (std::int64_t x = 0; x < width; ++x) {
      Image& block = blocks[static_cast<std::size_t>(x / kBlockPx)];
      if (y % kBlockPx == 0 && x % kBlockPx == 0) block = RoughRaster::block({0, x / kBlockPx, y / kBlockPx});
      const auto at = static_cast<std::size_t>(y % kBlockPx * kBlockPx + x % kBlockPx) * 4;
      file.write(reinterpret_cast<const char*>(&block.rgba[at]), 3);
    }
  }
  file.close();
  const std::string command = fmt::format(
      "cd '{}' && gdal_translate -q -co TILED=YES -a_srs '+proj=sinu +R=6378137' -a_ullr {} {} {} {} raster.ppm r.tif",
      folder.string(), -kHalf_m, 0.5 * kHalf_m, kHalf_m, -0.5 * kHalf_m);
  return std::system(command.c_str()) == 0;
}

int run(std::int64_t width, std::int64_t tiles, const std::filesystem::path& folder) {
  const WarpOptions options{.figure = {.ellipsoid = Ellipsoid(6378137.0, 0.0)}, .body = "sphere"};
  const std::int64_t height = width / 2;
  auto source = warp_source(std::make_unique<RoughRaster>(width, height), options, "raster");
  if (!source) return EXIT_FAILURE;
  const int finest = (*source)->info().grid.max_level;
  const double ours = own_seconds(**source, finest, tiles);
  fmt::print("terrella  {:.2f} s of processor for {} × {} pixels\n", ours, width, height);
  if (!folder.empty()) {
    if (!write_for_gdal(folder, width, height)) return EXIT_FAILURE;
    const double before = cpu_seconds(RUSAGE_CHILDREN);
    const std::string command = fmt::format(
        "cd '{}' && gdalwarp -q -overwrite -r cubic -et 0.05 -t_srs '+proj=longlat +R=6378137 +no_defs' "
        "-te -180 -90 180 90 -ts {} {} r.tif warped.tif",
        folder.string(), width, height);
    if (std::system(command.c_str()) != 0) return EXIT_FAILURE;
    const double theirs = cpu_seconds(RUSAGE_CHILDREN) - before;
    fmt::print("gdalwarp  {:.2f} s; terrella takes {:.2f} of it\n", theirs, ours / theirs);
  } else {
    fmt::print("the coarsest tiles  {:.2f} s\n", own_seconds(**source, 0, tiles));
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print("memory  {} MB\n", usage.ru_maxrss / 1024);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace terrella

int main(int argc, char** argv) {
  CLI::App app("Times streaming/warp beside gdalwarp, and measures its memory.");
  std::int64_t width = 4096, tiles = 1'000'000;
  std::string folder;
  app.add_option("--width", width, "columns of the raster");
  app.add_option("--tiles", tiles, "most tiles to make");
  app.add_option("--gdal", folder, "folder for gdalwarp's raster; without it gdalwarp does not run");
  CLI11_PARSE(app, argc, argv);
  return terrella::run(width, tiles, folder);
}
