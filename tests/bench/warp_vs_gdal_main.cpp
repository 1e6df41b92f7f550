// The time of all finest tiles of a raster, beside gdalwarp's for the same pixels, and the memory of a large raster.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <thread>
#include <vector>

#include "geo/body.h"
#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

constexpr int kBlockPx = 256;
constexpr double kHalf_m = 6378137.0 * 3.14159265358979323846;

/// A kind of raster, in units of its width; square except for the sinusoidal planet.
struct Kind {
  std::string crs, degrees;
  double west_m, north_m, width_m;
  bool is_planet = false;
  [[nodiscard]] std::int64_t rows(std::int64_t width) const { return is_planet ? width / 2 : width; }
};
const std::string kSphere = "+proj=longlat +R=6378137 +no_defs";
const std::map<std::string, Kind> kKinds = {
    {"sinusoidal", {"+proj=sinu +R=6378137", kSphere, -kHalf_m, 0.5 * kHalf_m, 2.0 * kHalf_m, true}},
    {"utm", {"+proj=utm +zone=32 +datum=WGS84", "EPSG:4326", 300e3, 5300e3, 400e3}},
    {"lambert", {"+proj=lcc +lat_1=33 +lat_2=45 +lat_0=39 +lon_0=-96 +R=6378137", kSphere, -2e6, 2e6, 4e6}},
    {"cap", {"+proj=stere +lat_0=90 +lat_ts=71 +R=6378137", kSphere, -3e6, 3e6, 6e6}}};

/// A raster whose rough blocks are made as they are read.
class RoughRaster : public RasterSource {
 public:
  RoughRaster(const Kind& kind, std::int64_t width) {
    const double pixel_m = kind.width_m / static_cast<double>(width);
    info_.crs = kind.crs + " +no_defs +type=crs";
    info_.levels = {{.width_px = width,
                     .height_px = kind.rows(width),
                     .block_width_px = kBlockPx,
                     .block_height_px = kBlockPx,
                     .to_crs = {kind.west_m, pixel_m, 0.0, kind.north_m, 0.0, -pixel_m}}};
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

/// Seconds of the processor and of the clock.
struct Cost {
  double cpu = 0.0, wall = 0.0;
};

Cost cost_of(int who, const std::function<bool()>& work) {
  const auto cpu_seconds = [who] {
    rusage usage{};
    getrusage(who, &usage);
    return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  };
  const double before = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  if (!work()) std::exit(EXIT_FAILURE);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  return {cpu_seconds() - before, took.count()};
}

struct Work {
  Kind kind;
  std::int64_t width, most_tiles;
  std::filesystem::path folder;
};

std::unique_ptr<TileSource> open(const Work& work) {
  const bool sphere = work.kind.degrees == kSphere;
  const WarpOptions options{.figure = {.ellipsoid = sphere ? Ellipsoid(6378137.0, 0.0) : earth().ellipsoid},
                            .body = sphere ? "sphere" : "earth"};
  auto source = warp_source(std::make_unique<RoughRaster>(work.kind, work.width), options, "raster");
  if (!source) std::exit(EXIT_FAILURE);
  return *std::move(source);
}

std::vector<TileId> tiles_of(const TileGrid& grid, int level, std::int64_t most) {
  std::vector<TileId> tiles;
  for (std::int64_t y = 0; y < rows(grid, level); ++y) {
    for (std::int64_t x = 0; x < columns(grid, level); ++x) {
      const TileId id{level, x, y};
      if (exists(grid, id) && std::ssize(tiles) < most) tiles.push_back(id);
    }
  }
  return tiles;
}

Cost own_cost(const Work& work, bool finest, int threads) {
  const auto source = open(work);
  const TileGrid& grid = source->info().grid;
  const auto tiles = tiles_of(grid, finest ? grid.max_level : 0, work.most_tiles);
  return cost_of(RUSAGE_SELF, [&] {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> made{true};
    const auto make = [&] {
      for (std::size_t i = next++; i < tiles.size(); i = next++) {
        const auto tile = source->read(tiles[i]);
        if (tile && !tile->make_picture()) made = false;
      }
    };
    std::vector<std::jthread> workers;
    for (int i = 1; i < threads; ++i) workers.emplace_back(make);
    make();
    workers.clear();
    return made.load();
  });
}

bool write_for_gdal(const Work& work) {
  const std::int64_t width = work.width, height = work.kind.rows(width);
  std::ofstream file(work.folder / "raster.ppm", std::ios::binary);
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
  const Kind& kind = work.kind;
  const double high_m = kind.width_m * static_cast<double>(height) / static_cast<double>(width);
  const std::string command = fmt::format(
      "cd '{}' && gdal_translate -q -co TILED=YES -a_srs '{} +no_defs' -a_ullr {} {} {} {} raster.ppm r.tif",
      work.folder.string(), kind.crs, kind.west_m, kind.north_m, kind.west_m + kind.width_m, kind.north_m - high_m);
  return std::system(command.c_str()) == 0;
}

/// gdalwarp over the area of the finest tiles.
Cost gdal_cost(const Work& work, const std::string& options) {
  const TileGrid grid = open(work)->info().grid;
  const auto tiles = tiles_of(grid, grid.max_level, work.most_tiles);
  const TileBounds first = tile_bounds(grid, tiles.front()), last = tile_bounds(grid, tiles.back());
  const double pixel_deg = tile_span_deg(grid, grid.max_level) / grid.tile_px;
  const double east = std::min(last.east_deg, 180.0), south = std::max(last.south_deg, -90.0);
  const std::string command = fmt::format(
      "cd '{}' && gdalwarp -q -overwrite -r cubic {} -t_srs '{}' -te {:.12f} {:.12f} {:.12f} {:.12f} -ts {} {} r.tif "
      "warped.tif",
      work.folder.string(), options, work.kind.degrees, first.west_deg, south, east, first.north_deg,
      std::llround((east - first.west_deg) / pixel_deg), std::llround((first.north_deg - south) / pixel_deg));
  return cost_of(RUSAGE_CHILDREN, [&] { return std::system(command.c_str()) == 0; });
}

/// Medians of several runs.
Cost median(int runs, const std::function<Cost()>& run) {
  std::vector<double> cpu, wall;
  for (int i = 0; i < runs; ++i) {
    const Cost cost = run();
    cpu.push_back(cost.cpu);
    wall.push_back(cost.wall);
  }
  std::ranges::sort(cpu);
  std::ranges::sort(wall);
  return {cpu[cpu.size() / 2], wall[wall.size() / 2]};
}

int run(const Work& work, int runs) {
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const Cost one = median(runs, [&] { return own_cost(work, true, 1); });
  fmt::print("terrella, a thread  {:.2f} s of processor\n", one.cpu);
  if (work.folder.empty()) {
    fmt::print("the coarsest tiles  {:.2f} s\n", own_cost(work, false, 1).cpu);
  } else {
    if (!write_for_gdal(work)) return EXIT_FAILURE;
    const Cost many = median(runs, [&] { return own_cost(work, true, threads); });
    fmt::print("terrella, {} threads  {:.2f} s of the clock\n", threads, many.wall);
    for (const char* error : {"", "-et 0.05", "-et 0"}) {
      const Cost plain = median(runs, [&] { return gdal_cost(work, error); });
      fmt::print("gdalwarp {}  {:.2f} s of processor; terrella takes {:.2f} of it\n", error, plain.cpu,
                 one.cpu / plain.cpu);
      const Cost multi =
          median(runs, [&] { return gdal_cost(work, fmt::format("{} -multi -wo NUM_THREADS=ALL_CPUS", error)); });
      fmt::print("gdalwarp {} -multi  {:.2f} s of the clock; terrella takes {:.2f} of it\n", error, multi.wall,
                 many.wall / multi.wall);
    }
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
  std::string folder, kind = "sinusoidal";
  int runs = 1;
  app.add_option("--raster", kind, "projection of the raster")->check(CLI::IsMember(terrella::kKinds));
  app.add_option("--width", width, "columns of the raster");
  app.add_option("--tiles", tiles, "most tiles to make");
  app.add_option("--runs", runs, "the medians of so many runs")->check(CLI::PositiveNumber);
  app.add_option("--gdal", folder, "folder for gdalwarp's raster; without it gdalwarp does not run");
  CLI11_PARSE(app, argc, argv);
  return terrella::run({terrella::kKinds.at(kind), width, tiles, folder}, runs);
}
