#include "streaming/raster/rows/row_raster.h"

#include <cstring>

namespace terrella {
namespace {

class RowRaster : public RasterSource {
 public:
  RowRaster(std::shared_ptr<BlockStore> store, RasterInfo info) : store_(std::move(store)), info_(std::move(info)) {}
  [[nodiscard]] const RasterInfo& info() const override { return info_; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& block) override {
    return block_tile(
        info_, block, [store = store_, block] { return stored_numbers(*store, block.x, block.y); },
        [store = store_, block] { return stored_picture(*store, block.x, block.y); });
  }

 private:
  std::shared_ptr<BlockStore> store_;
  RasterInfo info_;
};

}  // namespace

std::unique_ptr<RasterSource> make_row_raster(RowPicture picture, const CrsPlace& place,
                                              const std::filesystem::path& work_folder) {
  RasterInfo info;
  info.name = std::move(picture.name);
  info.crs = place.crs;
  info.opaque = picture.pixels.pixel_bytes == 3;
  info.by_rows = true;
  if (picture.is_numbers) info.numbers = NumberInfo{.scale = 1.0, .offset = 0.0, .nodata = {}, .floats = true};
  auto store = std::make_shared<BlockStore>(picture.pixels, temporary_folder(work_folder), std::move(picture.next_row));
  info.levels.push_back({.width_px = picture.pixels.width_px,
                         .height_px = picture.pixels.height_px,
                         .block_width_px = store->block_width_px(),
                         .block_height_px = store->block_height_px(),
                         .to_crs = place.to_crs});
  return std::make_unique<RowRaster>(std::move(store), std::move(info));
}

Result<Image, TileFailure> stored_picture(BlockStore& store, std::int64_t column, std::int64_t row) {
  auto pixels = store.read(column, row);
  if (!pixels) return TileFailure{.kind = MissingKind::broken, .why = pixels.error().message};
  return Image{.width_px = store.block_width_px(), .height_px = store.block_height_px(), .rgba = *std::move(pixels)};
}

Result<Numbers, TileFailure> stored_numbers(BlockStore& store, std::int64_t column, std::int64_t row) {
  const auto pixels = store.read(column, row);
  if (!pixels) return TileFailure{.kind = MissingKind::broken, .why = pixels.error().message};
  Numbers numbers{.width_px = store.block_width_px(), .height_px = store.block_height_px(), .values = {}};
  numbers.values.resize(pixels->size() / sizeof(float));
  std::memcpy(numbers.values.data(), pixels->data(), pixels->size());
  return numbers;
}

bool has_block(const RasterInfo& info, const TileId& block) {
  const bool has_level = block.level >= 0 && block.level < static_cast<int>(info.levels.size());
  if (!has_level || block.x < 0 || block.y < 0) return false;
  const RasterLevel& level = info.levels[static_cast<std::size_t>(block.level)];
  const auto blocks = [](std::int64_t pixels, int each) { return (pixels + each - 1) / each; };
  return block.x < blocks(level.width_px, level.block_width_px) &&
         block.y < blocks(level.height_px, level.block_height_px);
}

Result<EncodedTile, TileFailure> block_tile(const RasterInfo& info, const TileId& block,
                                            decltype(EncodedTile::make_numbers) numbers,
                                            decltype(EncodedTile::make_picture) picture) {
  if (!has_block(info, block)) return TileFailure{.kind = MissingKind::absent, .why = {}};
  EncodedTile tile;
  if (info.numbers) {
    tile.make_numbers = std::move(numbers);
  } else {
    tile.make_picture = std::move(picture);
  }
  return tile;
}

std::filesystem::path temporary_folder(const std::filesystem::path& given) {
  std::error_code failed;
  return given.empty() ? std::filesystem::temp_directory_path(failed) : given;
}

}  // namespace terrella
