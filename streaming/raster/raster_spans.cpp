#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "streaming/raster/gdal/raster_dataset.h"
#include "streaming/raster/gdal/raster_header.h"
#include "streaming/raster/raster_file.h"

namespace terrella {
namespace {

/// A block of a band that the file stores.
struct StoredBlock {
  GDALRasterBandH band;
  std::int64_t u, v;  ///< column and row
  ByteSpan span;
};

/// Calls `use` for each stored block of a band that a window touches, until one fails.
template <class Use>
Status for_each_stored_block(GDALRasterBandH band, const PixelWindow& window, const Use& use) {
  int wide = 1, high = 1;
  gdal().GDALGetBlockSize(band, &wide, &high);
  const std::int64_t right = std::min<std::int64_t>(window.x + window.width_px, gdal().GDALGetRasterBandXSize(band));
  const std::int64_t bottom = std::min<std::int64_t>(window.y + window.height_px, gdal().GDALGetRasterBandYSize(band));
  for (std::int64_t v = window.y / high; v * high < bottom; ++v) {
    for (std::int64_t u = window.x / wide; u * wide < right; ++u) {
      const auto item = [&](const char* what) {
        const char* text = gdal().GDALGetMetadataItem(band, fmt::format("{}_{}_{}", what, u, v).c_str(), "TIFF");
        return text == nullptr ? std::uint64_t{0} : std::strtoull(text, nullptr, 10);
      };
      const ByteSpan span{.offset = item("BLOCK_OFFSET"), .size = item("BLOCK_SIZE")};
      if (span.offset == 0 || span.size == 0) continue;
      if (Status used = use(StoredBlock{band, u, v, span}); !used) return used;
    }
  }
  return Done{};
}

Status decode(const StoredBlock& block, const GdalMessages& messages) {
  int wide = 1, high = 1;
  gdal().GDALGetBlockSize(block.band, &wide, &high);
  std::vector<double> samples(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high));  // the widest type
  const CPLErr read =
      gdal().GDALReadBlock(block.band, static_cast<int>(block.u), static_cast<int>(block.v), samples.data());
  return read == CE_None ? Status(Done{}) : failure(messages);
}

template <class Use>
Status for_each_stored(DatasetPool& pool, const RasterHeader& header, int overview, const PixelWindow& window,
                       std::span<const std::size_t> bands, const Use& use) {
  return pool.lend([&](GDALDatasetH dataset, const GdalMessages& messages) -> Status {
    std::vector<GDALRasterBandH> planes;
    for (const std::size_t band : header.separate ? bands : bands.first(1)) {
      planes.push_back(band_of(dataset, band, overview));
    }
    if (header.has_mask && planes.front() != nullptr) planes.push_back(gdal().GDALGetMaskBand(planes.front()));
    for (GDALRasterBandH plane : planes) {
      const auto use_block = [&](const StoredBlock& block) { return use(block, messages); };
      if (plane == nullptr) continue;
      if (Status used = for_each_stored_block(plane, window, use_block); !used) return used;
    }
    return Done{};
  });
}

}  // namespace

Result<std::vector<ByteSpan>> RasterFile::spans(const PixelWindow& window, std::span<const std::size_t> bands) const {
  std::vector<ByteSpan> found;
  const Status looked = for_each_stored(*pool_, header_, overviews_[window.level], window, bands,
                                        [&](const StoredBlock& block, const GdalMessages&) -> Status {
                                          found.push_back(block.span);
                                          return Done{};
                                        });
  if (!looked) return looked.error();
  return found;
}

Status RasterFile::check(const PixelWindow& window, std::span<const std::size_t> bands, const ByteSpan& span) const {
  return for_each_stored(*pool_, header_, overviews_[window.level], window, bands,
                         [&](const StoredBlock& block, const GdalMessages& messages) {
                           return block.span.offset == span.offset ? decode(block, messages) : Status(Done{});
                         });
}

}  // namespace terrella
