#include "streaming/raster/gdal/raster_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/number.h"

namespace terrella {
namespace {

/// More overviews than a raster of 2^20 pixels a side has.
constexpr int kMostOverviews = 40;
constexpr int kMostBands = 1 << 16;
/// Largest block that is read as a whole although it is the whole level, bytes.
constexpr std::int64_t kMostWholeBytes = 4LL << 20;

std::string structure_item(GDALMajorObjectH object, const char* name) {
  const char* value = gdal().GDALGetMetadataItem(object, name, "IMAGE_STRUCTURE");
  return value == nullptr ? "" : value;
}

std::string text_of(const char* text) { return text == nullptr ? "" : text; }

std::optional<SampleType> sample_type(GDALRasterBandH band) {
  switch (gdal().GDALGetRasterDataType(band)) {
    case GDT_Byte:
      return structure_item(band, "PIXELTYPE") == "SIGNEDBYTE" ? SampleType::int8 : SampleType::uint8;
    case GDT_UInt16:
      return SampleType::uint16;
    case GDT_Int16:
      return SampleType::int16;
    case GDT_UInt32:
      return SampleType::uint32;
    case GDT_Int32:
      return SampleType::int32;
    case GDT_UInt64:
      return SampleType::uint64;
    case GDT_Int64:
      return SampleType::int64;
    case GDT_Float32:
      return SampleType::float32;
    case GDT_Float64:
      return SampleType::float64;
    default:
      return {};
  }
}

BandColour colour_of(GDALRasterBandH band) {
  switch (gdal().GDALGetRasterColorInterpretation(band)) {
    case GCI_Undefined:
      return BandColour::none;
    case GCI_GrayIndex:
      return BandColour::gray;
    case GCI_PaletteIndex:
      return BandColour::palette;
    case GCI_RedBand:
      return BandColour::red;
    case GCI_GreenBand:
      return BandColour::green;
    case GCI_BlueBand:
      return BandColour::blue;
    case GCI_AlphaBand:
      return BandColour::alpha;
    default:
      return BandColour::other;
  }
}

std::optional<double> nodata_of(GDALRasterBandH band, SampleType type) {
  int is_stated = 0;
  double value = 0.0;
  if (type == SampleType::int64) {
    value = static_cast<double>(gdal().GDALGetRasterNoDataValueAsInt64(band, &is_stated));
  } else if (type == SampleType::uint64) {
    value = static_cast<double>(gdal().GDALGetRasterNoDataValueAsUInt64(band, &is_stated));
  } else {
    value = gdal().GDALGetRasterNoDataValue(band, &is_stated);
  }
  return is_stated != 0 ? std::optional(value) : std::nullopt;
}

void read_statistics(GDALRasterBandH band, RasterBand& facts) {
  double least = 0.0, most = 0.0, mean = 0.0, deviation = 0.0;
  // 1: approximate ones will do; 0: none are computed.
  if (gdal().GDALGetRasterStatistics(band, 1, 0, &least, &most, &mean, &deviation) != CE_None) return;
  facts.least = least;
  facts.most = most;
}

Result<RasterBand> read_band(GDALRasterBandH band, std::size_t index) {
  const auto type = sample_type(band);
  if (!type) return Error{fmt::format("its band {} holds complex numbers, which have no one value", index + 1)};
  RasterBand facts{.type = *type, .stored_bits = static_cast<int>(8 * sample_bytes(*type))};
  if (const auto bits = read_number(structure_item(band, "NBITS"))) facts.stored_bits = static_cast<int>(*bits);
  facts.colour = colour_of(band);
  facts.nodata = nodata_of(band, *type);
  int is_stated = 0;
  const double scale = gdal().GDALGetRasterScale(band, &is_stated);
  const double offset = gdal().GDALGetRasterOffset(band, &is_stated);
  if (std::isfinite(scale) && scale != 0.0) facts.scale = scale;
  if (std::isfinite(offset)) facts.offset = offset;
  facts.unit = text_of(gdal().GDALGetRasterUnitType(band));
  facts.description = text_of(gdal().GDALGetDescription(band));
  read_statistics(band, facts);
  return facts;
}

bool has_own_mask(GDALRasterBandH band) {
  const int flags = gdal().GDALGetMaskFlags(band);
  return (flags & GMF_PER_DATASET) != 0 && (flags & GMF_ALPHA) == 0;
}

/// `in_strips`: a block as large as the level is a strip.
RasterShape shape_of(GDALRasterBandH band, std::size_t bands, SampleType type, bool in_strips) {
  RasterShape shape{.width_px = gdal().GDALGetRasterBandXSize(band), .height_px = gdal().GDALGetRasterBandYSize(band)};
  int wide = 0, high = 0;
  gdal().GDALGetBlockSize(band, &wide, &high);
  shape.rows_per_strip = std::clamp<std::int64_t>(high, 1, shape.height_px);
  const auto bytes = static_cast<std::int64_t>(bands * sample_bytes(type)) * wide * high;
  const bool reaches_beyond = wide > shape.width_px || high > shape.height_px;
  const bool is_whole = wide == shape.width_px && high == shape.height_px && high > 1 && bytes <= kMostWholeBytes;
  shape.tiled = wide < shape.width_px || reaches_beyond || (is_whole && !in_strips);
  if (shape.tiled) {
    shape.block_width_px = wide;
    shape.block_height_px = high;
  }
  return shape;
}

/// True if `part` shows the same as `whole`, with sides divided by one number.
bool is_smaller_version(const RasterShape& part, const RasterShape& whole) {
  if (part.width_px >= whole.width_px && part.height_px >= whole.height_px) return false;
  const auto width = static_cast<double>(whole.width_px);
  const auto height = static_cast<double>(whole.height_px);
  const double by = std::max(width / static_cast<double>(part.width_px), height / static_cast<double>(part.height_px));
  return std::abs(width / by - static_cast<double>(part.width_px)) <= 1.0 &&
         std::abs(height / by - static_cast<double>(part.height_px)) <= 1.0;
}

void read_levels(GDALDatasetH dataset, bool in_strips, DatasetHeader& found) {
  const GDALRasterBandH first = band_of(dataset, 0, -1);
  RasterHeader& header = found.header;
  const SampleType type = header.bands.front().type;
  const RasterShape whole = shape_of(first, header.bands.size(), type, in_strips);
  std::vector<std::pair<RasterShape, int>> levels{{whole, -1}};
  const int count = std::min(kMostOverviews, gdal().GDALGetOverviewCount(first));
  const std::size_t last = header.bands.size() - 1;
  for (int i = 0; i < count; ++i) {
    const GDALRasterBandH overview = band_of(dataset, 0, i);
    if (overview == nullptr || band_of(dataset, last, i) == nullptr || sample_type(overview) != type) continue;
    const RasterShape shape = shape_of(overview, header.bands.size(), type, in_strips);
    const bool known = std::ranges::any_of(levels, [&](const auto& level) {
      return level.first.width_px == shape.width_px && level.first.height_px == shape.height_px;
    });
    if (known || !is_smaller_version(shape, whole) || has_own_mask(overview) != header.has_mask) continue;
    levels.emplace_back(shape, i);
  }
  std::ranges::sort(levels, {}, [](const auto& level) { return level.first.width_px * level.first.height_px; });
  for (const auto& [shape, overview] : levels) {
    header.levels.push_back(shape);
    found.overviews.push_back(overview);
  }
}

void read_palette(GDALRasterBandH band, RasterHeader& header) {
  GDALColorTableH table = gdal().GDALGetRasterColorTable(band);
  if (table == nullptr) return;
  for (int i = 0; i < gdal().GDALGetColorEntryCount(table); ++i) {
    GDALColorEntry entry{};
    gdal().GDALGetColorEntryAsRGB(table, i, &entry);
    const auto byte = [](short value) { return static_cast<std::uint8_t>(std::clamp<int>(value, 0, 255)); };
    header.palette.push_back({byte(entry.c1), byte(entry.c2), byte(entry.c3), byte(entry.c4)});
  }
}

std::string colour_title(const RasterHeader& header) {
  const auto has = [&](BandColour colour) {
    return std::ranges::find(header.bands, colour, &RasterBand::colour) != header.bands.end();
  };
  std::string title = "gray";
  if (has(BandColour::palette)) title = "palette";
  if (has(BandColour::red) && has(BandColour::green) && has(BandColour::blue)) title = "RGB";
  return has(BandColour::alpha) ? title + " with alpha" : title;
}

std::string layout_of(GDALDatasetH dataset, const RasterHeader& header) {
  const RasterShape& whole = header.whole();
  std::string compression = structure_item(dataset, "COMPRESSION");
  if (compression.empty()) compression = "not compressed";
  if (compression == "DEFLATE") compression = "deflate";
  return fmt::format(
      "{}, {}{}, {}", colour_title(header),
      whole.tiled ? fmt::format("tiles of {}x{}", whole.block_width_px, whole.block_height_px) : "strips",
      header.bands.size() > 1 && structure_item(dataset, "INTERLEAVE") == "BAND" ? ", bands separate" : "",
      compression);
}

/// Gives bands the colours of a TIFF's own tags, where GDAL's metadata give them none.
void add_colours(const TiffTags& tiff, std::vector<RasterBand>& bands) {
  const bool has_none = std::ranges::all_of(bands, [](const RasterBand& b) { return b.colour == BandColour::none; });
  const std::size_t colours = tiff.rgb ? 3 : 1;
  if (has_none && tiff.rgb && bands.size() >= colours) {
    constexpr std::array kColours{BandColour::red, BandColour::green, BandColour::blue};
    for (std::size_t i = 0; i < colours; ++i) bands[i].colour = kColours[i];
  }
  if (has_none && tiff.has_alpha && bands.size() > colours) bands[colours].colour = BandColour::alpha;
  if (tiff.other) bands.front().colour = BandColour::other;
  for (RasterBand& band : bands) band.premultiplied = tiff.premultiplied && band.colour == BandColour::alpha;
}

Status check_sizes(GDALDatasetH dataset) {
  const int width = gdal().GDALGetRasterXSize(dataset), height = gdal().GDALGetRasterYSize(dataset);
  const int bands = gdal().GDALGetRasterCount(dataset);
  if (width > kMaxRasterSide_px || height > kMaxRasterSide_px) {
    return Error{
        fmt::format("{}x{} pixels are too many; a side may have at most {}", width, height, kMaxRasterSide_px)};
  }
  if (bands > kMostBands) return Error{fmt::format("{} bands are too many; it may have at most {}", bands, kMostBands)};
  return Done{};
}

Status check_blocks(const RasterHeader& header) {
  const std::uint64_t pixel = header.bands.size() * sample_bytes(header.bands.front().type);
  for (const RasterShape& level : header.levels) {
    const auto pixels = static_cast<std::uint64_t>(level.has_blocks() ? level.block_width_px * level.block_height_px
                                                                      : level.width_px * level.rows_per_strip);
    const std::uint64_t most = level.has_blocks() ? kMaxBlockBytes : kMaxStripBytes;
    if (pixels * pixel <= most) continue;
    return Error{
        fmt::format("one of its {} needs {} MiB of memory, and at most {} MiB are held; save it with smaller "
                    "ones, or fewer bands (gdal_translate -co TILED=YES -b 1 -b 2 -b 3)",
                    level.has_blocks() ? "tiles" : "strips", (pixels * pixel) >> 20, most >> 20)};
  }
  return Done{};
}

}  // namespace

GDALDataType gdal_type(SampleType type) {
  switch (type) {
    case SampleType::uint8:
    case SampleType::int8:
      return GDT_Byte;
    case SampleType::uint16:
      return GDT_UInt16;
    case SampleType::int16:
      return GDT_Int16;
    case SampleType::uint32:
      return GDT_UInt32;
    case SampleType::int32:
      return GDT_Int32;
    case SampleType::uint64:
      return GDT_UInt64;
    case SampleType::int64:
      return GDT_Int64;
    case SampleType::float32:
      return GDT_Float32;
    case SampleType::float64:
      return GDT_Float64;
  }
  return GDT_Unknown;
}

GDALRasterBandH band_of(GDALDatasetH dataset, std::size_t band, int overview) {
  const GDALRasterBandH whole = gdal().GDALGetRasterBand(dataset, static_cast<int>(band) + 1);
  return whole == nullptr || overview < 0 ? whole : gdal().GDALGetOverview(whole, overview);
}

Result<DatasetHeader> read_header(GDALDatasetH dataset, const TiffTags& tiff) {
  DatasetHeader found;
  RasterHeader& header = found.header;
  if (Status sizes = check_sizes(dataset); !sizes) return sizes.error();
  header.driver = text_of(gdal().GDALGetDescription(gdal().GDALGetDatasetDriver(dataset)));
  for (int i = 0; i < gdal().GDALGetRasterCount(dataset); ++i) {
    auto band = read_band(gdal().GDALGetRasterBand(dataset, i + 1), static_cast<std::size_t>(i));
    if (!band) return band.error();
    header.bands.push_back(*std::move(band));
  }
  add_colours(tiff, header.bands);
  const GDALRasterBandH first = gdal().GDALGetRasterBand(dataset, 1);
  header.has_mask = has_own_mask(first);
  header.inverted = structure_item(dataset, "MINISWHITE") == "YES";
  if (header.bands.front().colour == BandColour::palette) read_palette(first, header);
  read_levels(dataset, tiff.in_strips, found);
  if (Status blocks = check_blocks(header); !blocks) return blocks.error();
  header.layout = layout_of(dataset, header);
  header.is_compressed = !structure_item(dataset, "COMPRESSION").empty();
  header.separate = structure_item(dataset, "INTERLEAVE") == "BAND";
  return found;
}

}  // namespace terrella
