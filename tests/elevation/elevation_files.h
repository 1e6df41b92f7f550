#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tiles/elevation_source.h"

/// Rasters of heights, and tile sets of them as the cutter and GDAL write them.
namespace terrella::test {

/// A raster of a whole planet, rows from the north.
struct Raster {
  int width = 0;
  int height = 0;
  std::vector<double> values;
  [[nodiscard]] double at(std::int64_t x, std::int64_t y) const {
    return values[static_cast<std::size_t>(y * width + x)];
  }
};

/// Whole numbers of a fixed seed in [least, most].
[[nodiscard]] Raster random_raster(int width, int height, int least, int most);
/// Writes it by GDAL as a file of a type ("UInt16", "Int16", "Float32") in EPSG:4326; the format follows the name.
/// `nodata`: what GDAL is to know as no data.
void write_raster(const std::filesystem::path& path, const Raster& raster, const std::string& type,
                  const std::string& nodata = "");
/// gdal_translate -of GPKG with more options; add_overviews() adds a coarser level.
void write_gdal_geopackage(const std::filesystem::path& from, const std::filesystem::path& to,
                           const std::string& options = "");
void add_overviews(const std::filesystem::path& geopackage);

/// A gray PNG of 16 bits, side × side.
[[nodiscard]] std::vector<std::byte> gray16_png(const std::vector<std::uint16_t>& values);
/// A TIFF of 32-bit floats, side × side, in strips of 5 rows.
[[nodiscard]] std::vector<std::byte> float_tiff(const std::vector<float>& values);

/// Opens; a failure of the test if that fails.
[[nodiscard]] std::optional<ElevationSource> must_open(const std::filesystem::path& path);
/// Calls `check` with a pixel of the raster and its height in the set's finest level; tiles that are not there fail
/// the test.
void for_each_height(const ElevationSource& source, const Raster& raster,
                     const std::function<void(std::int64_t x, std::int64_t y, double height_m)>& check);

}  // namespace terrella::test
