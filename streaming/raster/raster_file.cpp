#include "streaming/raster/raster_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "streaming/file_bytes.h"
#include "streaming/georeference/side_files.h"
#include "streaming/other_formats.h"
#include "streaming/raster/gdal/gdal_memory_files.h"
#include "streaming/raster/gdal/raster_dataset.h"
#include "streaming/raster/gdal/raster_header.h"
#include "streaming/raster/gdal/vrt_sources.h"
#include "streaming/raster/picture_kind.h"

namespace terrella {
namespace {

/// True if a dataset's bands are the bands of the level.
bool is_dataset_of(GDALDatasetH dataset, GDALRasterBandH first, std::size_t bands) {
  return dataset != nullptr && gdal().GDALGetRasterCount(dataset) == static_cast<int>(bands) &&
         gdal().GDALGetRasterBand(dataset, 1) == first;
}

/// A block of strips has this many rows, or one strip.
constexpr std::int64_t kStripBlockRows = 128;

Error refuse(const std::string& name, const std::string& what) {
  return Error{fmt::format("{}: {}; get it again, or save it as another raster (gdal_translate -of COG)", name, what)};
}

Result<std::shared_ptr<const RasterFile>> open_source(DatasetSource source, std::string shown_name,
                                                      const TiffTags& tags) {
  std::vector<std::string> remarks;
  auto handle = open_first_dataset(source, shown_name, remarks);
  if (!handle) return refuse(shown_name, handle.error().message);
  auto said = place_of(source, *handle, tags);
  const GdalMessages messages;
  auto found = read_header((*handle)->read(), tags);
  if (!found) return refuse(shown_name, found.error().message);
  // A fault in a later directory is found when its overviews are looked up.
  if (!messages.error().empty()) return refuse(shown_name, without_name(messages.error(), source.name));
  for (const std::string& warning : messages.warnings()) {
    remarks.push_back(fmt::format("{}: {}", shown_name, without_name(warning, source.name)));
  }
  found->header.name = std::move(shown_name);
  found->header.is_local_tiff = !source.option.empty();
  found->header.said = std::move(said);
  found->header.remarks = std::move(remarks);
  auto pool = std::make_shared<DatasetPool>(std::move(source));
  pool->give_back(*std::move(handle));
  return std::make_shared<const RasterFile>(std::move(pool), std::move(found->header), std::move(found->overviews));
}

/// True for a TIFF whose rows a tag turns. A stated place is that of the stored rows, as in GDAL, which ignores the
/// tag.
bool is_turned(const RasterFile& file, int orientation) {
  return orientation > 1 && orientation <= 8 && !file.header().said && !is_placed_as_stored(file.name());
}

/// Advice for a file that GDAL does not read, if its first bytes tell what it is.
Error with_hint(const std::string& name, const Error& error) {
  const auto head = read_head(name, kFormatHeadBytes);
  const std::string hint = head ? convert_hint(name, as_text(*head)) : std::string();
  return hint.empty() ? error : Error{fmt::format("{}: {}", name, hint)};
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

Result<std::shared_ptr<const RasterFile>> RasterFile::open(const std::string& name) {
  if (const auto loaded = load_gdal(); !loaded) return Error{fmt::format("{}: {}", name, loaded.error().message)};
  const auto head = read_head(name, 8);
  if (!head && picture_kind(name) == PictureKind::none) return Error{head.error().message};
  if (head && begins_as_tiff(as_text(*head))) {
    const auto bytes = open_byte_file(name);
    if (!bytes) return bytes.error();
    const TiffTags tags = read_tiff_tags(**bytes);
    auto file = open_source(DatasetSource{.name = name, .option = "GEOREF_SOURCES=INTERNAL,PAM"}, name, tags);
    if (file && is_turned(**file, tags.orientation)) {
      return Error{
          fmt::format("{}: its Orientation tag ({}) turns it, and a TIFF is read as it is stored; turn it "
                      "upright: convert {} -auto-orient upright.tif",
                      name, tags.orientation, shell_word(name))};
    }
    return file;
  }
  if (Status checked = check_vrt_sources(name); head && !checked) return checked.error();
  auto file = open_source(DatasetSource{.name = name}, name, {});
  return file ? file : with_hint(name, file.error());
}

Result<std::shared_ptr<const RasterFile>> RasterFile::open(std::shared_ptr<const ByteFile> bytes) {
  const std::string name = bytes->name();
  if (const auto loaded = load_gdal(); !loaded) return Error{fmt::format("{}: {}", name, loaded.error().message)};
  const TiffTags colours = read_tiff_tags(*bytes);
  auto mounted = std::make_shared<GdalMount>(std::move(bytes));
  return open_source(DatasetSource{.name = mounted->path(), .alone = true, .mounted = mounted}, name, colours);
}

std::shared_ptr<const RasterFile> RasterFile::over(std::shared_ptr<const ByteFile> bytes) const {
  auto mounted = std::make_shared<GdalMount>(std::move(bytes));
  auto pool = std::make_shared<DatasetPool>(DatasetSource{.name = mounted->path(), .alone = true, .mounted = mounted});
  return std::make_shared<const RasterFile>(std::move(pool), header_, overviews_);
}

std::shared_ptr<const RasterFile> RasterFile::in_strip_blocks() const {
  RasterHeader header = header_;
  std::vector<int> overviews;
  const std::uint64_t pixel = header.bands.size() * sample_bytes(header.bands.front().type);
  std::vector<RasterShape> levels;
  for (std::size_t i = 0; i < header.levels.size(); ++i) {
    RasterShape level = header.levels[i];
    if (!level.has_blocks()) {
      const std::int64_t strip = level.rows_per_strip;
      const std::int64_t rows = std::min(level.height_px, (kStripBlockRows + strip - 1) / strip * strip);
      if (static_cast<std::uint64_t>(level.width_px * rows) * pixel <= kMostStripBlockBytes) {
        level.block_width_px = level.width_px;
        level.block_height_px = rows;
      }
    }
    if (!level.has_blocks() && i + 1 < header.levels.size()) continue;
    levels.push_back(level);
    overviews.push_back(overviews_[i]);
  }
  header.levels = std::move(levels);
  return std::make_shared<const RasterFile>(pool_, std::move(header), std::move(overviews));
}

}  // namespace terrella
