#include "streaming/mosaic/sheet_tiles.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "streaming/mosaic/area_mean.h"
#include "streaming/mosaic/sheet_raster.h"
#include "streaming/warp/make_warp_source.h"

namespace terrella {
namespace {

constexpr std::size_t kMostSheets = 32;
constexpr std::size_t kLeastDecodedBytes = 2UL << 20;

/// Puts tiles over each other, the topmost first.
Result<Block, TileFailure> stacked(const std::vector<EncodedTile>& tiles, int side_px, bool numbers) {
  const PixelScale same{.width_px = side_px, .height_px = side_px};
  AreaMean mean({.width = side_px, .height = side_px}, numbers);
  for (const EncodedTile& tile : tiles) {
    const auto block = decode_tile(tile);
    if (!block) return block.error();
    mean.add(*block, 0, 0, same);
    mean.end_file();
  }
  return mean.finish();
}

}  // namespace

Result<Block, TileFailure> decode_tile(const EncodedTile& tile) {
  if (tile.make_numbers) {
    auto numbers = tile.make_numbers();
    if (!numbers) return numbers.error();
    return Block(*std::move(numbers));
  }
  auto image = tile.make_picture ? tile.make_picture() : Result<Image, TileFailure>(Image{});
  if (!tile.make_picture) {
    auto decoded = decode_image(tile.bytes);
    if (!decoded) return TileFailure{MissingKind::broken, decoded.error().message};
    image = *std::move(decoded);
  }
  if (!image) return image.error();
  return Block(*std::move(image));
}

SheetTiles::SheetTiles(const MosaicIndex& index, OpenRasters& rasters, const TileGrid& grid, const Body& body)
    : index_(index), rasters_(rasters), grid_(grid), body_(body) {}

Result<std::shared_ptr<TileSource>> SheetTiles::open(int sheet) {
  const std::lock_guard lock(mutex_);
  const auto known = std::ranges::find(open_, sheet, &std::pair<int, std::shared_ptr<TileSource>>::first);
  if (known != open_.end()) {
    open_.splice(open_.begin(), open_, known);
    return open_.front().second;
  }
  auto raster =
      make_sheet_raster(index_.files, index_.sheets[static_cast<std::size_t>(sheet)], rasters_, index_.numbers);
  const WarpFigure figure{.ellipsoid = body_.ellipsoid, .latitude = index_.latitude, .crs_latitude = index_.latitude};
  auto planner = TilePlanner::open(raster->info(), figure, grid_, Overviews::made);
  if (!planner) return planner.error();
  TileSetInfo info;
  info.grid = grid_;
  info.format = ImageFormat::png;
  info.numbers = raster->info().numbers;
  const std::size_t bytes =
      std::max(kLeastDecodedBytes, kWarpDecodedBytes / std::min(index_.sheets.size(), kMostSheets));
  open_.emplace_front(sheet, make_warp_source(std::move(raster), *std::move(planner), std::move(info), {}, bytes));
  if (open_.size() > kMostSheets) open_.pop_back();
  return open_.front().second;
}

Result<EncodedTile, TileFailure> SheetTiles::make(const TileId& id, const std::vector<int>& sheets) {
  std::vector<EncodedTile> tiles;
  for (auto sheet = sheets.rbegin(); sheet != sheets.rend(); ++sheet) {
    const auto source = open(*sheet);
    if (!source) return TileFailure{MissingKind::broken, source.error().message};
    auto tile = (*source)->read(id);
    if (!tile && tile.error().kind != MissingKind::blank && tile.error().kind != MissingKind::absent) return tile;
    if (tile) tiles.push_back(*std::move(tile));
  }
  if (tiles.empty()) return TileFailure{MissingKind::blank, {}};
  if (tiles.size() == 1) return std::move(tiles.front());
  const bool numbers = index_.numbers;
  auto pixels = stacked(tiles, grid_.tile_px, numbers);
  if (!pixels) return pixels.error();
  EncodedTile tile;
  if (numbers) {
    tile.make_numbers = [made = std::move(std::get<Numbers>(*pixels))]() -> Result<Numbers, TileFailure> {
      return made;
    };
  } else {
    tile.make_picture = [made = std::move(std::get<Image>(*pixels))]() -> Result<Image, TileFailure> { return made; };
  }
  return tile;
}

Result<double, TileFailure> SheetTiles::value_at(const Geodetic& place, const Ellipsoid& figure,
                                                 const std::vector<int>& sheets) {
  for (auto sheet = sheets.rbegin(); sheet != sheets.rend(); ++sheet) {
    const auto source = open(*sheet);
    if (!source) return TileFailure{MissingKind::broken, source.error().message};
    auto value = (*source)->value_at(place, figure);
    if (value || value.error().kind == MissingKind::broken) return value;
  }
  return TileFailure{MissingKind::blank, "no data"};
}

}  // namespace terrella
