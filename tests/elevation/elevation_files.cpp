#include "elevation_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "../streaming/streaming_test_support.h"
#include "streaming/cut/output/gray16_png.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

void run(const std::string& command) { ASSERT_EQ(std::system(command.c_str()), 0) << command; }

int side_of(std::size_t values) { return static_cast<int>(std::lround(std::sqrt(static_cast<double>(values)))); }

}  // namespace

Raster random_raster(int width, int height, int least, int most) {
  std::mt19937 random(11);
  Raster raster{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    raster.values.push_back(least + static_cast<int>(random() % static_cast<unsigned>(most - least + 1)));
  }
  return raster;
}

void write_raster(const fs::path& path, const Raster& raster, const std::string& type, const std::string& nodata) {
  const fs::path text = path.string() + ".asc";
  {
    std::ofstream out(text);
    out << fmt::format("ncols {}\nnrows {}\nxllcorner -180\nyllcorner -90\ncellsize {:.17g}\n", raster.width,
                       raster.height, 360.0 / raster.width);
    if (!nodata.empty()) out << "NODATA_value " << nodata << "\n";
    for (int y = 0; y < raster.height; ++y) {
      for (int x = 0; x < raster.width; ++x) out << raster.at(x, y) << (x + 1 == raster.width ? '\n' : ' ');
    }
  }
  run(fmt::format("{} -q -ot {} -a_srs EPSG:4326 '{}' '{}'", TERRELLA_GDAL_TRANSLATE, type, text.string(),
                  path.string()));
}

void write_gdal_geopackage(const fs::path& from, const fs::path& to, const std::string& options) {
  run(fmt::format("{} -q -of GPKG {} '{}' '{}'", TERRELLA_GDAL_TRANSLATE, options, from.string(), to.string()));
}

void add_overviews(const fs::path& geopackage) {
  run(fmt::format("{} -q -r average '{}' 2", TERRELLA_GDALADDO, geopackage.string()));
}

std::vector<std::byte> gray16_png(const std::vector<std::uint16_t>& values) {
  return *encode_gray16_png(values, side_of(values.size()));
}

std::vector<std::byte> float_tiff(const std::vector<float>& values) {
  const ScratchFolder folder;
  const fs::path path = folder / "tile.tif";
  const int side = side_of(values.size());
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, side);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, side);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 5);
  for (int y = 0; y < side; ++y) {
    std::vector<float> row(values.begin() + y * side, values.begin() + (y + 1) * side);
    TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0);
  }
  TIFFClose(tiff);
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return bytes_of(text);
}

std::optional<ElevationSource> must_open(const fs::path& path) {
  auto tiles = open_tile_set(path);
  EXPECT_TRUE(tiles) << tiles.error().message;
  if (!tiles) return {};
  auto source = ElevationSource::open(*std::move(tiles), path.string());
  EXPECT_TRUE(source) << source.error().message;
  return source ? std::optional(*std::move(source)) : std::nullopt;
}

void for_each_height(const ElevationSource& source, const Raster& raster,
                     const std::function<void(std::int64_t x, std::int64_t y, double height_m)>& check) {
  const TileGrid& grid = source.grid();
  ASSERT_NEAR(tile_span_deg(grid, grid.max_level) / grid.tile_px, 360.0 / raster.width, 1e-12);
  for (std::int64_t row = 0; row < rows(grid, grid.max_level); ++row) {
    for (std::int64_t column = 0; column < columns(grid, grid.max_level); ++column) {
      const auto tile = source.read({.level = grid.max_level, .x = column, .y = row});
      ASSERT_TRUE(tile) << tile.error().why;
      for (int i = 0; i < grid.tile_px * grid.tile_px; ++i) {
        const std::int64_t x = column * grid.tile_px + i % grid.tile_px;
        const std::int64_t y = row * grid.tile_px + i / grid.tile_px;
        if (x < raster.width && y < raster.height) {
          check(x, y, static_cast<double>(tile->heights_m[static_cast<std::size_t>(i)]));
        }
      }
    }
  }
}

}  // namespace terrella::test
