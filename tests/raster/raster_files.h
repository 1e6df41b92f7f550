#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "codecs/image.h"
#include "codecs/numbers.h"
#include "streaming/raster/open_raster.h"
#include "streaming/raster/raster_file.h"
#include "tests/support/scratch_folder.h"

namespace terrella::test {

/// Runs a shell command without its output; true if it succeeds.
bool run(const std::string& command);
/// Runs `gdal_translate -q OPTIONS FROM TO`.
bool translate(const std::string& options, const std::filesystem::path& from, const std::filesystem::path& to);
/// Runs `gdaladdo -q OPTIONS FILE FACTORS`.
bool add_overviews(const std::string& options, const std::filesystem::path& file, const std::string& factors);

/// Value of a pixel: column, row, band.
using PixelValue = std::function<double(int, int, int)>;

/// Writes raw samples that GDAL reads (ENVI), bands one after another. `type` as GDAL names it: Byte, UInt16, Int16,
/// UInt32, Int32, Float32, Float64.
void write_raw(const std::filesystem::path& path, const std::string& type, int width, int height, int bands,
               const PixelValue& value);

/// All pixels as GDAL reads them, bands one after another, as Float64. `level` -1: the raster; 0: its first overview.
struct GdalPixels {
  int width = 0;
  int height = 0;
  std::vector<double> values;
  [[nodiscard]] double at(int x, int y, int band) const {
    return values[(static_cast<std::size_t>(band) * height + y) * width + x];
  }
};
GdalPixels read_by_gdal(const std::filesystem::path& file, int bands, int level = -1);

/// Facts of describe_raster() about a file.
RasterFacts facts_of(const std::filesystem::path& path);

/// A place somewhere on Earth, in degrees.
CrsPlace some_place();

/// All blocks of a level put together. Failures are reported to the test.
Image whole_picture(RasterSource& source, std::size_t level);
Numbers whole_numbers(RasterSource& source, std::size_t level);

/// Noise, the same for the same arguments, in [0, 1).
double noise_at(int x, int y, int band);

}  // namespace terrella::test
