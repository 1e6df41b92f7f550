#include "streaming/raster/raster_file.h"

#include <fmt/format.h>

#include "streaming/raster/gdal/raster_dataset.h"
#include "streaming/raster/gdal/raster_header.h"

namespace terrella {
namespace {

/// True if a dataset's bands are the bands of the level.
bool is_dataset_of(GDALDatasetH dataset, GDALRasterBandH first, std::size_t bands) {
  return dataset != nullptr && gdal().GDALGetRasterCount(dataset) == static_cast<int>(bands) &&
         gdal().GDALGetRasterBand(dataset, 1) == first;
}

}  // namespace

Status RasterFile::read(const PixelWindow& window, std::span<const std::size_t> bands, SampleType type,
                        std::uint8_t* samples, std::size_t row_bytes) const {
  const int overview = overviews_[window.level];
  const auto x = static_cast<int>(window.x), y = static_cast<int>(window.y);
  const auto width = static_cast<int>(window.width_px), height = static_cast<int>(window.height_px);
  const auto sample = static_cast<GSpacing>(sample_bytes(type));
  const auto pixel = static_cast<GSpacing>(bands.size()) * sample;
  const auto row = row_bytes > 0 ? static_cast<GSpacing>(row_bytes) : pixel * width;
  return pool_->lend([&](GDALDatasetH dataset, const GdalMessages& messages) -> Status {
    const GDALRasterBandH first = band_of(dataset, 0, overview);
    if (first == nullptr) return Error{"one of its levels is gone"};
    if (GDALDatasetH level = gdal().GDALGetBandDataset(first);
        bands.size() > 1 && is_dataset_of(level, first, header_.bands.size())) {
      std::vector<int> numbers;
      for (const std::size_t band : bands) numbers.push_back(static_cast<int>(band) + 1);
      const CPLErr read =
          gdal().GDALDatasetRasterIOEx(level, GF_Read, x, y, width, height, samples, width, height, gdal_type(type),
                                       static_cast<int>(numbers.size()), numbers.data(), pixel, row, sample, nullptr);
      return read == CE_None ? Status(Done{}) : failure(messages);
    }
    for (std::size_t i = 0; i < bands.size(); ++i) {
      const GDALRasterBandH band = band_of(dataset, bands[i], overview);
      if (band == nullptr) return Error{fmt::format("one of its levels has no band {}", bands[i] + 1)};
      const CPLErr read = gdal().GDALRasterIOEx(band, GF_Read, x, y, width, height, samples + i * sample_bytes(type),
                                                width, height, gdal_type(type), pixel, row, nullptr);
      if (read != CE_None) return failure(messages);
    }
    return Done{};
  });
}

Status RasterFile::read_mask(const PixelWindow& window, std::uint8_t* shown) const {
  const int overview = overviews_[window.level];
  const auto width = static_cast<int>(window.width_px), height = static_cast<int>(window.height_px);
  return pool_->lend([&](GDALDatasetH dataset, const GdalMessages& messages) -> Status {
    const GDALRasterBandH band = band_of(dataset, 0, overview);
    const GDALRasterBandH mask = band == nullptr ? nullptr : gdal().GDALGetMaskBand(band);
    if (mask == nullptr) return Error{"its mask is gone"};
    const CPLErr read = gdal().GDALRasterIOEx(mask, GF_Read, static_cast<int>(window.x), static_cast<int>(window.y),
                                              width, height, shown, width, height, GDT_Byte, 1, width, nullptr);
    return read == CE_None ? Status(Done{}) : failure(messages);
  });
}

}  // namespace terrella
