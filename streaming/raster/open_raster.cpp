#include "streaming/raster/open_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

#include "streaming/raster/rows/row_raster.h"
#include "streaming/raster/tiff_coding.h"
#include "streaming/raster/tiff_level.h"
#include "streaming/raster/tiff_source.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Conversion of samples to the pixels of blocks.
struct PixelCoding {
  std::optional<ColourConverter> colours;
  std::optional<NumberCoding> numbers;  ///< set: blocks are numbers, and there are no colours
};

/// One level: tiles that are read by themselves, or rows that are read once.
struct RasterPart {
  TiffLevel level;
  std::unique_ptr<TiffTileLevel> tiles;
  std::unique_ptr<TiffRowLevel> rows;
  std::unique_ptr<BlockStore> store;
};

/// Files and codings that blocks are decoded from. They live as long as the last block.
struct TiffParts {
  std::string name;
  PixelCoding coding;
  std::vector<RasterPart> parts;
};

TileFailure broken_block(const TiffParts& parts, const TileId& block, const std::string& why) {
  return {
      .kind = MissingKind::broken,
      .why = fmt::format("{}: block {}, {} of level {} cannot be read: {}; the file is truncated or damaged, get it "
                         "again",
                         parts.name, block.x, block.y, block.level, why)};
}

Result<Image, TileFailure> picture_of(TiffParts& parts, const TileId& block) {
  RasterPart& part = parts.parts[static_cast<std::size_t>(block.level)];
  if (part.tiles) {
    auto image = part.tiles->colours(block.x, block.y, *parts.coding.colours);
    if (!image) return broken_block(parts, block, image.error().message);
    return *std::move(image);
  }
  return stored_picture(*part.store, block.x, block.y);
}

Result<Numbers, TileFailure> heights_of(TiffParts& parts, const TileId& block) {
  RasterPart& part = parts.parts[static_cast<std::size_t>(block.level)];
  if (part.tiles) {
    auto numbers = part.tiles->numbers(block.x, block.y, *parts.coding.numbers);
    if (!numbers) return broken_block(parts, block, numbers.error().message);
    return *std::move(numbers);
  }
  return stored_numbers(*part.store, block.x, block.y);
}

bool is_wider_than_floats(SampleType type) { return type != SampleType::float32 && sample_bytes(type) >= 4; }

Result<double> exact_sample_at(RasterPart& part, std::int64_t column, std::int64_t row, std::size_t band) {
  if (part.tiles) return part.tiles->exact_sample_at(column, row, band);
  TiffSampleRows rows(part.level.part, 1);
  const auto samples = rows.read(row);
  if (!samples) return samples.error();
  const TiffSamples& kind = part.level.part.picture.samples;
  return exact_sample(kind, band, *samples + static_cast<std::size_t>(column) * kind.pixel_bytes());
}

class TiffRaster : public TiffSource {
 public:
  TiffRaster(std::shared_ptr<TiffParts> parts, RasterInfo info) : parts_(std::move(parts)), info_(std::move(info)) {}
  [[nodiscard]] const RasterInfo& info() const override { return info_; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& block) override {
    if (!has_block(info_, block)) return TileFailure{.kind = MissingKind::absent, .why = {}};
    EncodedTile tile;
    if (parts_->coding.numbers) {
      tile.make_numbers = [parts = parts_, block] { return heights_of(*parts, block); };
    } else {
      tile.make_picture = [parts = parts_, block] { return picture_of(*parts, block); };
    }
    return tile;
  }

  [[nodiscard]] Result<double, TileFailure> value_at(std::int64_t column, std::int64_t row) override {
    auto value = RasterSource::value_at(column, row);
    if (!value) return value;
    // Blocks are floats, with the scale and the offset of the coding applied.
    const NumberCoding& coding = *parts_->coding.numbers;
    const bool rounded = is_wider_than_floats(parts_->parts.back().level.part.picture.samples.type) ||
                         coding.scale != 1.0 || coding.offset != 0.0;
    if (!rounded) return value;
    const auto sample = exact_sample_at(parts_->parts.back(), column, row, coding.band);
    if (!sample) return TileFailure{MissingKind::broken, parts_->name + ": " + sample.error().message};
    return (*sample * coding.scale + coding.offset) * info_.numbers->scale + info_.numbers->offset;
  }

  [[nodiscard]] Result<std::vector<ByteSpan>> spans(const TileId& block) override {
    if (!has_block(info_, block)) return std::vector<ByteSpan>();
    const RasterPart& part = parts_->parts[static_cast<std::size_t>(block.level)];
    return part.tiles ? part.tiles->spans(block.x, block.y) : std::vector<ByteSpan>();
  }

  [[nodiscard]] Status check(const TileId& block, const ByteSpan& span, std::span<const std::byte> bytes) override {
    const RasterPart& part = parts_->parts[static_cast<std::size_t>(block.level)];
    return part.tiles ? part.tiles->check(block.x, block.y, span, bytes) : Status(Done{});
  }

  [[nodiscard]] std::unique_ptr<TiffSource> over(const std::shared_ptr<const ByteFile>& file) const override {
    auto parts = std::make_shared<TiffParts>(TiffParts{parts_->name, parts_->coding, {}});
    for (const RasterPart& part : parts_->parts) {
      assert(part.tiles);
      TiffLevel level = part.level;
      level.part.file = file;
      if (level.mask) level.mask->file = file;
      parts->parts.push_back(
          {.level = level, .tiles = std::make_unique<TiffTileLevel>(level), .rows = {}, .store = {}});
    }
    return std::make_unique<TiffRaster>(std::move(parts), info_);
  }

 private:
  std::shared_ptr<TiffParts> parts_;
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

RasterPart make_part(const TiffLevel& level, const TiffParts& parts, const RasterOptions& options, bool opaque) {
  RasterPart part{.level = level, .tiles = {}, .rows = {}, .store = {}};
  if (level.has_blocks()) {
    part.tiles = std::make_unique<TiffTileLevel>(level);
    return part;
  }
  part.rows = std::make_unique<TiffRowLevel>(level, options.jobs);
  const TiffPicture& picture = level.part.picture;
  const StoredPixels pixels{.width_px = picture.width_px,
                            .height_px = picture.height_px,
                            .pixel_bytes = opaque && !options.heights ? std::size_t{3} : std::size_t{4}};
  auto next_row = [&coding = parts.coding, rows = part.rows.get(), y = std::int64_t{0},
                   numbers = std::vector<float>()](std::span<std::uint8_t> pixel_row) mutable {
    if (!coding.numbers) return rows->colours(y++, *coding.colours, pixel_row.data());
    numbers.resize(pixel_row.size() / sizeof(float));
    Status read = rows->numbers(y++, *coding.numbers, numbers.data());
    std::memcpy(pixel_row.data(), numbers.data(), pixel_row.size());
    return read;
  };
  part.store = std::make_unique<BlockStore>(pixels, temporary_folder(options.work_folder), std::move(next_row));
  return part;
}

RasterLevel shape_of(const RasterPart& part, const CrsPlace& place, const TiffPicture& whole) {
  const TiffPicture& picture = part.level.part.picture;
  const double columns = static_cast<double>(whole.width_px) / static_cast<double>(picture.width_px);
  const double rows = static_cast<double>(whole.height_px) / static_cast<double>(picture.height_px);
  return {.width_px = picture.width_px,
          .height_px = picture.height_px,
          .block_width_px = part.tiles ? static_cast<int>(picture.tile_width_px) : part.store->block_width_px(),
          .block_height_px = part.tiles ? static_cast<int>(picture.tile_height_px) : part.store->block_height_px(),
          .to_crs = scaled_place(place.to_crs, columns, rows)};
}

Result<PixelCoding> choose_coding(const TiffPyramid& pyramid, const RasterOptions& options) {
  CodingOptions given{.nodata = options.nodata,
                      .scale = options.scale,
                      .offset = options.offset,
                      .band = {},
                      .composite = options.composite};
  if (options.band > 0) given.band = static_cast<std::size_t>(options.band - 1);
  PixelCoding coding;
  if (options.heights) {
    const auto numbers = numbers_of(pyramid, given);
    if (!numbers) return numbers.error();
    coding.numbers = *numbers;
    return coding;
  }
  auto colours = colours_of(pyramid, given);
  if (!colours) return colours.error();
  coding.colours = *std::move(colours);
  return coding;
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
NumberInfo numbers_info(const TiffPyramid& pyramid, const RasterOptions& options, PixelCoding& coding) {
  const BandMetadata band = pyramid.metadata.band(static_cast<std::size_t>(std::max(options.band, 1) - 1));
  NumberInfo info{
      .scale = 1.0, .offset = 0.0, .nodata = {}, .floats = true, .unit = band.unit, .quantity = band.description};
  if (!options.stored || !coding.numbers) return info;
  info.scale = std::exchange(coding.numbers->scale, 1.0);
  info.offset = std::exchange(coding.numbers->offset, 0.0);
  info.whole = whole_range(pyramid.whole().part.picture.samples.type, coding.numbers->nodata);
  return info;
}

}  // namespace

Result<std::unique_ptr<RasterSource>> open_raster(const fs::path& path, const CrsPlace& place,
                                                  const RasterOptions& options) {
  auto pyramid = read_pyramid(path);
  if (!pyramid) return pyramid.error();
  auto source = make_tiff_source(*std::move(pyramid), path.string(), place, options);
  if (!source) return source.error();
  return std::unique_ptr<RasterSource>(*std::move(source));
}

Result<std::unique_ptr<TiffSource>> make_tiff_source(TiffPyramid pyramid, const std::string& name,
                                                     const CrsPlace& place, const RasterOptions& options) {
  auto coding = choose_coding(pyramid, options);
  if (!coding) return coding.error();
  const TiffLevel& whole = pyramid.whole();
  const NumberInfo meaning = numbers_info(pyramid, options, *coding);
  RasterInfo info{.name = fs::path(name).stem().string(), .attribution = {}, .crs = place.crs, .levels = {}};
  info.opaque = !whole.mask && coding->colours && !coding->colours->samples().may_be_clear();
  if (options.heights) info.numbers = meaning;
  const auto nodata = options.nodata ? options.nodata : pyramid.metadata.nodata;
  auto parts = std::make_shared<TiffParts>(TiffParts{name, *std::move(coding), {}});
  for (TiffLevel& level : pyramid.levels) {
    level.part.picture.samples.nodata = nodata;  // for tiles that are not stored
    parts->parts.push_back(make_part(level, *parts, options, info.opaque));
    info.levels.push_back(shape_of(parts->parts.back(), place, whole.part.picture));
    info.by_rows = info.by_rows || !level.has_blocks();
  }
  return std::unique_ptr<TiffSource>(std::make_unique<TiffRaster>(std::move(parts), std::move(info)));
}

}  // namespace terrella
