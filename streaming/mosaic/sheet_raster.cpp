#include "streaming/mosaic/sheet_raster.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "streaming/mosaic/area_mean.h"
#include "streaming/raster/rows/row_raster.h"

namespace terrella {
namespace {

/// An overview of a side that does not divide evenly is a little coarser than its name says.
constexpr double kSlightlyCoarser = 1.05;

/// The part of a level's pixels that a range of the result needs.
std::pair<std::int64_t, std::int64_t> needed(double corner, double size, std::int64_t from, int count,
                                             std::int64_t limit) {
  const double begin = (static_cast<double>(from) - corner) / size;
  const double end = (static_cast<double>(from + count) - corner) / size;
  return {std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(begin)), 0, limit),
          std::clamp<std::int64_t>(static_cast<std::int64_t>(std::ceil(end)), 0, limit)};
}

class SheetRaster : public RasterSource {
 public:
  SheetRaster(const std::vector<PlacedFile>& files, const MosaicSheet& sheet, OpenRasters& rasters, bool numbers)
      : files_(files), sheet_(sheet), rasters_(rasters), numbers_(numbers), info_(raster_info_of(sheet, numbers)) {}

  [[nodiscard]] const RasterInfo& info() const override { return info_; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& block) override {
    if (!has_block(info_, block)) return TileFailure{MissingKind::absent, {}};
    const RasterLevel& level = info_.levels[static_cast<std::size_t>(block.level)];
    const std::int64_t x = block.x * level.block_width_px, y = block.y * level.block_height_px;
    const MeanBox box{.x = x,
                      .y = y,
                      .width = static_cast<int>(std::min<std::int64_t>(level.block_width_px, level.width_px - x)),
                      .height = static_cast<int>(std::min<std::int64_t>(level.block_height_px, level.height_px - y))};
    const int halvings = sheet_.levels - 1 - block.level;
    std::vector<SheetPart> under = parts_under(box, halvings);
    if (under.empty()) return TileFailure{MissingKind::blank, {}};
    EncodedTile tile;
    if (numbers_) {
      tile.make_numbers = [this, box, halvings, under = std::move(under)]() -> Result<Numbers, TileFailure> {
        return std::get<Numbers>(mean(box, halvings, under));
      };
    } else {
      tile.make_picture = [this, box, halvings, under = std::move(under)]() -> Result<Image, TileFailure> {
        return std::get<Image>(mean(box, halvings, under));
      };
    }
    return tile;
  }

 private:
  /// The files under a rectangle, the topmost first.
  [[nodiscard]] std::vector<SheetPart> parts_under(const MeanBox& box, int halvings) const {
    const std::int64_t west = box.x << halvings, north = box.y << halvings;
    const std::int64_t east = (box.x + box.width) << halvings, south = (box.y + box.height) << halvings;
    std::vector<SheetPart> under;
    for (const SheetPart& part : sheet_.parts) {
      const MosaicFile& file = files_[static_cast<std::size_t>(part.file)].file;
      if (part.column < east && part.row < south && part.column + file.width_px() > west &&
          part.row + file.height_px() > north) {
        under.push_back(part);
      }
    }
    std::ranges::reverse(under);
    return under;
  }

  [[nodiscard]] Block mean(const MeanBox& box, int halvings, const std::vector<SheetPart>& under) const {
    AreaMean mean(box, numbers_);
    for (const SheetPart& part : under) {
      add(part, halvings, box, mean);
      mean.end_file();
      if (mean.is_full()) break;
    }
    return mean.finish();
  }

  /// Adds the blocks of a file. A block that cannot be read is left out; OpenRasters has named the file.
  void add(const SheetPart& part, int halvings, const MeanBox& box, AreaMean& mean) const {
    const MosaicFile& file = files_[static_cast<std::size_t>(part.file)].file;
    const int index = level_for(file, halvings);
    const auto shape = rasters_.level(part.file, index);
    if (!shape) return;
    const double pixel = std::ldexp(1.0, -halvings);
    const PixelScale scale{
        .corner_x = static_cast<double>(part.column) * pixel,
        .corner_y = static_cast<double>(part.row) * pixel,
        .size_x = pixel * static_cast<double>(file.width_px()) / static_cast<double>(shape->width_px),
        .size_y = pixel * static_cast<double>(file.height_px()) / static_cast<double>(shape->height_px),
        .width_px = shape->width_px,
        .height_px = shape->height_px};
    const auto [left, right] = needed(scale.corner_x, scale.size_x, box.x, box.width, shape->width_px);
    const auto [top, bottom] = needed(scale.corner_y, scale.size_y, box.y, box.height, shape->height_px);
    if (left >= right || top >= bottom) return;
    const std::int64_t wide = shape->block_width_px, high = shape->block_height_px;
    for (std::int64_t y = top / high; y * high < bottom; ++y) {
      for (std::int64_t x = left / wide; x * wide < right; ++x) {
        const auto block = rasters_.block(part.file, {.level = index, .x = x, .y = y});
        if (block) mean.add(**block, x * wide, y * high, scale);
      }
    }
  }

  const std::vector<PlacedFile>& files_;
  const MosaicSheet& sheet_;
  OpenRasters& rasters_;
  const bool numbers_;
  const RasterInfo info_;
};

}  // namespace

int level_for(const MosaicFile& file, int halvings) {
  const double most = std::ldexp(kSlightlyCoarser, halvings);
  for (std::size_t i = 0; i < file.sizes.size(); ++i) {
    const double coarser = static_cast<double>(file.width_px()) / static_cast<double>(file.sizes[i].first);
    if (coarser <= most) return static_cast<int>(i);
  }
  return static_cast<int>(file.sizes.size()) - 1;
}

RasterInfo raster_info_of(const MosaicSheet& sheet, bool numbers) {
  RasterInfo info{.name = {}, .attribution = {}, .crs = sheet.crs, .levels = {}};
  if (numbers) info.numbers = NumberInfo{.scale = 1.0, .offset = 0.0, .nodata = {}, .floats = true};
  for (int halvings = sheet.levels - 1; halvings >= 0; --halvings) {
    const double pixel = std::ldexp(1.0, halvings);
    const std::int64_t rest = (std::int64_t{1} << halvings) - 1;
    RasterLevel level{.width_px = (sheet.width_px + rest) >> halvings,
                      .height_px = (sheet.height_px + rest) >> halvings,
                      .block_width_px = sheet.block_width_px,
                      .block_height_px = sheet.block_height_px,
                      .to_crs = sheet.to_crs};
    level.to_crs.x_per_column *= pixel;
    level.to_crs.y_per_column *= pixel;
    level.to_crs.x_per_row *= pixel;
    level.to_crs.y_per_row *= pixel;
    info.levels.push_back(level);
  }
  return info;
}

std::unique_ptr<RasterSource> make_sheet_raster(const std::vector<PlacedFile>& files, const MosaicSheet& sheet,
                                                OpenRasters& rasters, bool numbers) {
  return std::make_unique<SheetRaster>(files, sheet, rasters, numbers);
}

}  // namespace terrella
