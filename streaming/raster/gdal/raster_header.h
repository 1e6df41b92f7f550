#pragma once

#include <vector>

#include "streaming/raster/gdal/gdal_library.h"
#include "streaming/raster/raster_file.h"
#include "streaming/raster/tiff_tags.h"

namespace terrella {

/// The header of an open dataset, and GDAL's index of each of its levels (-1: the raster itself).
struct DatasetHeader {
  RasterHeader header;
  std::vector<int> overviews;
};

/// Reads the facts of a dataset that has bands; `tiff` says what GDAL does not. Leaves RasterHeader::name empty.
/// Overviews of another shape, another type or without the raster's mask are left out. The error is the fault alone,
/// without the file's name.
[[nodiscard]] Result<DatasetHeader> read_header(GDALDatasetH dataset, const TiffTags& tiff);

/// GDAL's type for samples.
[[nodiscard]] GDALDataType gdal_type(SampleType type);

/// GDAL's band of a level; `overview`: -1 for the raster itself. `band` counts from 0.
[[nodiscard]] GDALRasterBandH band_of(GDALDatasetH dataset, std::size_t band, int overview);

}  // namespace terrella
