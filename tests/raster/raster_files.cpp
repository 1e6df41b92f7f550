#include "raster_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

template <class T>
void append(std::vector<char>& bytes, double value) {
  const auto sample = static_cast<T>(value);
  bytes.insert(bytes.end(), reinterpret_cast<const char*>(&sample), reinterpret_cast<const char*>(&sample + 1));
}

struct RawType {
  int envi_code;
  void (*append)(std::vector<char>&, double);
};

const std::map<std::string, RawType>& raw_types() {
  static const std::map<std::string, RawType> types{
      {"Byte", {1, append<std::uint8_t>}},    {"Int16", {2, append<std::int16_t>}},
      {"Int32", {3, append<std::int32_t>}},   {"Float32", {4, append<float>}},
      {"Float64", {5, append<double>}},       {"UInt16", {12, append<std::uint16_t>}},
      {"UInt32", {13, append<std::uint32_t>}}};
  return types;
}

/// Puts the pixels of each block of a level to `place(x, y, index in block)`.
template <class Place>
void for_block_pixels(const RasterLevel& level, const TileId& block, int block_width, int block_height,
                      const Place& place) {
  for (int y = 0; y < block_height; ++y) {
    for (int x = 0; x < block_width; ++x) {
      const std::int64_t column = block.x * level.block_width_px + x;
      const std::int64_t row = block.y * level.block_height_px + y;
      if (column < level.width_px && row < level.height_px) place(column, row, y * block_width + x);
    }
  }
}

template <class Use>
void for_blocks(RasterSource& source, std::size_t index, const Use& use) {
  const RasterLevel& level = source.info().levels[index];
  for (std::int64_t y = 0; y * level.block_height_px < level.height_px; ++y) {
    for (std::int64_t x = 0; x * level.block_width_px < level.width_px; ++x) {
      const TileId block{.level = static_cast<int>(index), .x = x, .y = y};
      auto tile = source.read(block);
      ASSERT_TRUE(tile) << tile.error().why;
      use(level, block, *tile);
    }
  }
}

}  // namespace

bool run(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

bool translate(const std::string& options, const fs::path& from, const fs::path& to) {
  return run(fmt::format("{} -q {} '{}' '{}'", TERRELLA_GDAL_TRANSLATE, options, from.string(), to.string()));
}

bool add_overviews(const std::string& options, const fs::path& file, const std::string& factors) {
  return run(fmt::format("{} -q {} '{}' {}", TERRELLA_GDALADDO, options, file.string(), factors));
}

void write_raw(const fs::path& path, const std::string& type, int width, int height, int bands,
               const PixelValue& value) {
  std::vector<char> bytes;
  for (int band = 0; band < bands; ++band) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) raw_types().at(type).append(bytes, value(x, y, band));
    }
  }
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  std::ofstream(path.string() + ".hdr") << fmt::format(
      "ENVI\nsamples = {}\nlines = {}\nbands = {}\nheader offset = 0\nfile type = ENVI Standard\n"
      "data type = {}\ninterleave = bsq\nbyte order = 0\n",
      width, height, bands, raw_types().at(type).envi_code);
}

/// Band by band, because GDAL 3.6 mixes up the bands of overviews when it copies all at once.
GdalPixels read_by_gdal(const fs::path& file, int bands, int level) {
  const ScratchFolder folder;
  const std::string overview = level < 0 ? "" : fmt::format("-oo OVERVIEW_LEVEL={} ", level);
  GdalPixels pixels;
  for (int band = 0; band < bands; ++band) {
    EXPECT_TRUE(translate(fmt::format("{} -b {} -of ENVI -ot Float64", overview, band + 1), file, folder / "out.raw"));
    std::ifstream header(folder / "out.hdr");
    for (std::string line; std::getline(header, line);) {
      std::sscanf(line.c_str(), "samples = %d", &pixels.width);
      std::sscanf(line.c_str(), "lines = %d", &pixels.height);
    }
    const std::size_t count = static_cast<std::size_t>(pixels.width) * pixels.height;
    pixels.values.resize(pixels.values.size() + count);
    std::ifstream data(folder / "out.raw", std::ios::binary);
    data.read(reinterpret_cast<char*>(pixels.values.data() + band * count),
              static_cast<std::streamsize>(count * sizeof(double)));
    EXPECT_TRUE(data.good()) << file;
  }
  return pixels;
}

RasterFacts facts_of(const std::filesystem::path& path) {
  const auto file = RasterFile::open(path);
  EXPECT_TRUE(file) << file.error().message;
  const auto facts = describe_raster(**file, {}, true);
  EXPECT_TRUE(facts) << facts.error().message;
  return *facts;
}

CrsPlace some_place() {
  return {.to_crs =
              {.x0 = 10.0, .x_per_column = 0.01, .x_per_row = 0.0, .y0 = 50.0, .y_per_column = 0.0, .y_per_row = -0.01},
          .crs = "EPSG:4326"};
}

Image whole_picture(RasterSource& source, std::size_t level_index) {
  const RasterLevel& shape = source.info().levels[level_index];
  Image whole{.width_px = static_cast<int>(shape.width_px), .height_px = static_cast<int>(shape.height_px)};
  whole.rgba.resize(static_cast<std::size_t>(whole.width_px) * whole.height_px * 4);
  for_blocks(source, level_index, [&](const RasterLevel& level, const TileId& block, EncodedTile& tile) {
    const auto image = tile.make_picture();
    ASSERT_TRUE(image) << image.error().why;
    for_block_pixels(level, block, image->width_px, image->height_px, [&](std::int64_t x, std::int64_t y, int index) {
      std::memcpy(whole.rgba.data() + (y * whole.width_px + x) * 4, image->rgba.data() + 4 * index, 4);
    });
  });
  return whole;
}

Numbers whole_numbers(RasterSource& source, std::size_t level_index) {
  const RasterLevel& shape = source.info().levels[level_index];
  Numbers whole{.width_px = static_cast<int>(shape.width_px), .height_px = static_cast<int>(shape.height_px)};
  whole.values.resize(static_cast<std::size_t>(whole.width_px) * whole.height_px);
  for_blocks(source, level_index, [&](const RasterLevel& level, const TileId& block, EncodedTile& tile) {
    const auto numbers = tile.make_numbers();
    ASSERT_TRUE(numbers) << numbers.error().why;
    for_block_pixels(level, block, numbers->width_px, numbers->height_px,
                     [&](std::int64_t x, std::int64_t y, int index) {
                       whole.values[static_cast<std::size_t>(y * whole.width_px + x)] =
                           numbers->values[static_cast<std::size_t>(index)];
                     });
  });
  return whole;
}

double noise_at(int x, int y, int band) {
  const auto whole = [](int number) { return static_cast<std::uint32_t>(number); };
  std::uint32_t hash = whole(x) * 374761393U + whole(y) * 668265263U + whole(band) * 974634533U;
  hash = (hash ^ (hash >> 13)) * 1274126177U;
  return static_cast<double>(hash ^ (hash >> 16)) / 4294967296.0;
}

}  // namespace terrella::test
