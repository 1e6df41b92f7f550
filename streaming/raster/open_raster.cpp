#include "streaming/raster/open_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "streaming/raster/file_source.h"
#include "streaming/raster/picture_kind.h"
#include "streaming/raster/rows/raster_rows.h"
#include "streaming/raster/rows/row_raster.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// A raster and how it is read. Lives as long as the last block.
struct RasterParts {
  std::shared_ptr<const RasterFile> file;
  PixelReading reading;
  std::vector<std::unique_ptr<BlockStore>> stores;  ///< for each level; null: its blocks are read by themselves
};

TileFailure broken_block(const RasterParts& parts, const TileId& block, const std::string& why) {
  return {.kind = MissingKind::broken,
          .why = fmt::format("{}: block {}, {} of level {} cannot be read: {}; the file is truncated or damaged, get "
                             "it again",
                             parts.file->name(), block.x, block.y, block.level, why)};
}

PixelWindow window_of(const RasterParts& parts, const TileId& block) {
  return window_of_block(parts.file->header(), static_cast<std::size_t>(block.level), block.x, block.y);
}

BlockStore* store_of(const RasterParts& parts, const TileId& block) {
  return parts.stores[static_cast<std::size_t>(block.level)].get();
}

Result<Image, TileFailure> picture_of(const RasterParts& parts, const TileId& block) {
  if (BlockStore* store = store_of(parts, block)) return stored_picture(*store, block.x, block.y);
  const PixelWindow window = window_of(parts, block);
  Image image{
      .width_px = static_cast<int>(window.width_px), .height_px = static_cast<int>(window.height_px), .rgba = {}};
  image.rgba.resize(static_cast<std::size_t>(window.width_px * window.height_px) * 4);
  const Status read = read_colours(*parts.file, parts.reading, window, image.rgba.data());
  return read ? Result<Image, TileFailure>(std::move(image)) : broken_block(parts, block, read.error().message);
}

Result<Numbers, TileFailure> numbers_of(const RasterParts& parts, const TileId& block) {
  if (BlockStore* store = store_of(parts, block)) return stored_numbers(*store, block.x, block.y);
  const PixelWindow window = window_of(parts, block);
  Numbers numbers{
      .width_px = static_cast<int>(window.width_px), .height_px = static_cast<int>(window.height_px), .values = {}};
  numbers.values.resize(static_cast<std::size_t>(window.width_px * window.height_px));
  const Status read = read_numbers(*parts.file, parts.reading, window, numbers.values.data());
  return read ? Result<Numbers, TileFailure>(std::move(numbers)) : broken_block(parts, block, read.error().message);
}

bool is_wider_than_floats(SampleType type) { return type != SampleType::float32 && sample_bytes(type) >= 4; }

class FileRaster : public FileSource {
 public:
  FileRaster(std::shared_ptr<RasterParts> parts, RasterInfo info) : parts_(std::move(parts)), info_(std::move(info)) {}
  [[nodiscard]] const RasterInfo& info() const override { return info_; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& block) override {
    return block_tile(
        info_, block, [parts = parts_, block] { return numbers_of(*parts, block); },
        [parts = parts_, block] { return picture_of(*parts, block); });
  }

  [[nodiscard]] Result<double, TileFailure> value_at(std::int64_t column, std::int64_t row) override {
    auto value = RasterSource::value_at(column, row);
    if (!value) return value;
    // Blocks are floats, with the scale and the offset of the coding applied.
    const NumberCoding& coding = parts_->reading.numbers;
    const bool rounded =
        is_wider_than_floats(parts_->reading.samples.type) || coding.scale != 1.0 || coding.offset != 0.0;
    if (!rounded) return value;
    const auto sample = read_exact(*parts_->file, parts_->reading, column, row);
    if (!sample) return TileFailure{MissingKind::broken, parts_->file->name() + ": " + sample.error().message};
    return (*sample * coding.scale + coding.offset) * info_.numbers->scale + info_.numbers->offset;
  }

  [[nodiscard]] Result<std::vector<ByteSpan>> spans(const TileId& block) override {
    if (!has_block(info_, block) || store_of(*parts_, block) != nullptr) return std::vector<ByteSpan>();
    return parts_->file->spans(window_of(*parts_, block), parts_->reading.bands);
  }

  [[nodiscard]] Status check(const TileId& block, const ByteSpan& span) override {
    if (!has_block(info_, block) || store_of(*parts_, block) != nullptr) return Done{};
    return parts_->file->check(window_of(*parts_, block), parts_->reading.bands, span);
  }

  [[nodiscard]] std::unique_ptr<FileSource> over(const std::shared_ptr<const ByteFile>& bytes) const override {
    auto parts = std::make_shared<RasterParts>(RasterParts{parts_->file->over(bytes), parts_->reading, {}});
    parts->stores.resize(parts_->stores.size());
    return std::make_unique<FileRaster>(std::move(parts), info_);
  }

 private:
  std::shared_ptr<RasterParts> parts_;
  RasterInfo info_;
};

/// The transform of an overview, which covers the same area as the picture.
Affine scaled_place(const Affine& place, double columns, double rows) {
  Affine scaled = place;
  scaled.x_per_column *= columns;
  scaled.y_per_column *= columns;
  scaled.x_per_row *= rows;
  scaled.y_per_row *= rows;
  return scaled;
}

/// Blocks of a level that is read by rows.
std::unique_ptr<BlockStore> make_store(const RasterParts& parts, std::size_t level, const RasterOptions& options,
                                       bool opaque) {
  const RasterShape& shape = parts.file->header().levels[level];
  if (shape.has_blocks()) return nullptr;
  const bool is_numbers = !parts.reading.colours;
  const StoredPixels pixels{.width_px = shape.width_px,
                            .height_px = shape.height_px,
                            .pixel_bytes = opaque && !is_numbers ? std::size_t{3} : std::size_t{4}};
  auto rows = std::make_shared<RasterRows>(parts.file, level, parts.reading, options.jobs);
  auto next_row = [rows = std::move(rows), is_numbers, y = std::int64_t{0},
                   numbers = std::vector<float>()](std::span<std::uint8_t> pixel_row) mutable {
    if (!is_numbers) return rows->colours(y++, pixel_row.data());
    numbers.resize(pixel_row.size() / sizeof(float));
    Status read = rows->numbers(y++, numbers.data());
    std::memcpy(pixel_row.data(), numbers.data(), pixel_row.size());
    return read;
  };
  return std::make_unique<BlockStore>(pixels, temporary_folder(options.work_folder), std::move(next_row));
}

RasterLevel level_of(const RasterShape& shape, const BlockStore* store, const CrsPlace& place,
                     const RasterShape& whole) {
  const double columns = static_cast<double>(whole.width_px) / static_cast<double>(shape.width_px);
  const double rows = static_cast<double>(whole.height_px) / static_cast<double>(shape.height_px);
  return {.width_px = shape.width_px,
          .height_px = shape.height_px,
          .block_width_px = store != nullptr ? store->block_width_px() : static_cast<int>(shape.block_width_px),
          .block_height_px = store != nullptr ? store->block_height_px() : static_cast<int>(shape.block_height_px),
          .to_crs = scaled_place(place.to_crs, columns, rows)};
}

Result<PixelReading> choose_reading(const RasterFile& file, const RasterOptions& options) {
  CodingOptions given{.nodata = options.nodata,
                      .scale = options.scale,
                      .offset = options.offset,
                      .band = {},
                      .composite = options.composite};
  if (options.band > 0) given.band = static_cast<std::size_t>(options.band - 1);
  return options.heights ? numbers_of(file, given) : colours_of(file, given);
}

/// The range of stored numbers of at most 16 bits, without a nodata at its end.
std::optional<WholeRange> whole_range(SampleType type, const std::optional<double>& nodata) {
  WholeRange range;
  switch (type) {
    case SampleType::uint8:
      range = {.least = 0, .most = 255};
      break;
    case SampleType::int8:
      range = {.least = -128, .most = 127};
      break;
    case SampleType::uint16:
      range = {.least = 0, .most = 65535};
      break;
    case SampleType::int16:
      range = {.least = -32768, .most = 32767};
      break;
    default:
      return {};
  }
  if (nodata == static_cast<double>(range.least)) ++range.least;
  if (nodata == static_cast<double>(range.most)) --range.most;
  return range;
}

/// The meaning of the blocks' numbers. Moves scale and offset into it if blocks keep the stored numbers.
NumberInfo numbers_info(const RasterFile& file, const RasterOptions& options, PixelReading& reading) {
  const RasterBand& band = file.header().bands[reading.bands.front()];
  NumberInfo info{
      .scale = 1.0, .offset = 0.0, .nodata = {}, .floats = true, .unit = band.unit, .quantity = band.description};
  if (!options.stored) return info;
  info.scale = std::exchange(reading.numbers.scale, 1.0);
  info.offset = std::exchange(reading.numbers.offset, 0.0);
  info.whole = whole_range(band.type, reading.numbers.nodata);
  return info;
}

}  // namespace

Result<std::unique_ptr<RasterSource>> open_raster(const fs::path& path, const CrsPlace& place,
                                                  const RasterOptions& options) {
  auto file = RasterFile::open(path.string());
  if (!file) return file.error();
  return raster_source(*std::move(file), place, options);
}

Result<std::unique_ptr<RasterSource>> raster_source(std::shared_ptr<const RasterFile> file, const CrsPlace& place,
                                                    const RasterOptions& options) {
  auto source = make_file_source(std::move(file), place, options);
  if (!source) return source.error();
  return std::unique_ptr<RasterSource>(*std::move(source));
}

PictureFile as_picture(const std::shared_ptr<const RasterFile>& file) {
  const RasterShape& whole = file->header().whole();
  return {file->name(), whole.width_px, whole.height_px, file};
}

Result<PictureFile> measure_raster(const fs::path& path) {
  const auto file = RasterFile::open(path.string());
  if (!file) return file.error();
  return as_picture(*file);
}

Result<std::unique_ptr<FileSource>> make_file_source(std::shared_ptr<const RasterFile> file, const CrsPlace& place,
                                                     const RasterOptions& options) {
  auto reading = choose_reading(*file, options);
  if (!reading) return reading.error();
  const RasterHeader& header = file->header();
  RasterInfo info{.name = fs::path(file->name()).stem().string(), .attribution = {}, .crs = place.crs, .levels = {}};
  info.opaque = !header.has_mask && reading->colours && !reading->samples.may_be_clear();
  if (options.heights) info.numbers = numbers_info(*file, options, *reading);
  auto parts = std::make_shared<RasterParts>(RasterParts{file, *std::move(reading), {}});
  for (std::size_t i = 0; i < header.levels.size(); ++i) {
    parts->stores.push_back(make_store(*parts, i, options, info.opaque));
    info.levels.push_back(level_of(header.levels[i], parts->stores.back().get(), place, header.whole()));
    info.by_rows = info.by_rows || parts->stores.back() != nullptr;
  }
  return std::unique_ptr<FileSource>(std::make_unique<FileRaster>(std::move(parts), std::move(info)));
}

bool holds_numbers(const RasterFile& file) {
  const ColourBands colours = colour_bands(file.header());
  return !colours.in_colours() && file.header().bands.front().type != SampleType::uint8 &&
         file.header().bands.front().colour != BandColour::other;
}

bool holds_numbers(const std::filesystem::path& path) {
  if (picture_kind(path) != PictureKind::raster) return false;
  const auto file = RasterFile::open(path.string());
  return file && holds_numbers(**file);
}

}  // namespace terrella
