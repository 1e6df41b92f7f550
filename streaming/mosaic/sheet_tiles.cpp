#include "streaming/mosaic/sheet_tiles.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "streaming/mosaic/area_mean.h"
#include "streaming/mosaic/sheet_raster.h"
#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

constexpr std::size_t kMostSheets = 32;
/// Bytes of decoded blocks, for all sheets together. The blocks are made of those that OpenRasters keeps.
constexpr std::size_t kSheetsDecodedBytes = 12UL << 20;
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

/// True if a place on a sheet's pixels lies on a part, or so near that the part's own transform decides.
bool is_near(const MosaicFile& file, const SheetPart& part, const CrsPoint& at) {
  constexpr double kNear_px = 1.0;
  const double x = at.x - static_cast<double>(part.column), y = at.y - static_cast<double>(part.row);
  return x > -kNear_px && y > -kNear_px && x < static_cast<double>(file.width_px()) + kNear_px &&
         y < static_cast<double>(file.height_px()) + kNear_px;
}

/// The value of a file's pixel at a point of its system.
Result<double, TileFailure> value_in(OpenRasters& rasters, int file, const Affine& to_crs, const CrsPoint& point) {
  const double x = point.x - to_crs.x0, y = point.y - to_crs.y0;
  const double area = to_crs.x_per_column * to_crs.y_per_row - to_crs.x_per_row * to_crs.y_per_column;
  const auto whole = [area](double pixels) { return static_cast<std::int64_t>(std::floor(pixels / area)); };
  return rasters.value_at(file, whole(x * to_crs.y_per_row - y * to_crs.x_per_row),
                          whole(y * to_crs.x_per_column - x * to_crs.y_per_column));
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

Result<SheetTiles::OpenSheet> SheetTiles::open(int sheet) {
  const std::lock_guard lock(mutex_);
  const auto known = std::ranges::find(open_, sheet, &std::pair<int, OpenSheet>::first);
  if (known != open_.end()) {
    open_.splice(open_.begin(), open_, known);
    return open_.front().second;
  }
  auto raster =
      make_sheet_raster(index_.files, index_.sheets[static_cast<std::size_t>(sheet)], rasters_, index_.numbers);
  const WarpFigure figure{.ellipsoid = body_.ellipsoid, .latitude = index_.latitude, .crs_latitude = index_.latitude};
  auto planner = TilePlanner::open(raster->info(), figure, grid_, Overviews::made, Detail::full);
  if (!planner) return planner.error();
  TileSetInfo info;
  info.grid = grid_;
  info.format = ImageFormat::png;
  info.numbers = raster->info().numbers;
  const std::size_t bytes =
      std::max(kLeastDecodedBytes, kSheetsDecodedBytes / std::min(index_.sheets.size(), kMostSheets));
  OpenSheet opened{.tiles = make_warp_source(std::move(raster), *planner, std::move(info), {}, bytes),
                   .planner = *planner};
  open_.emplace_front(sheet, std::move(opened));
  if (open_.size() > kMostSheets) open_.pop_back();
  return open_.front().second;
}

Result<EncodedTile, TileFailure> SheetTiles::make(const TileId& id, const std::vector<int>& sheets) {
  std::vector<EncodedTile> tiles;
  for (auto sheet = sheets.rbegin(); sheet != sheets.rend(); ++sheet) {
    const auto source = open(*sheet);
    if (!source) return TileFailure{MissingKind::failed, source.error().message};
    auto tile = source->tiles->read(id);
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
    const auto opened = open(*sheet);
    if (!opened) return TileFailure{MissingKind::failed, opened.error().message};
    const MosaicSheet& from = index_.sheets[static_cast<std::size_t>(*sheet)];
    const double row_deg = row_latitude_deg(grid_, figure, Ellipsoid::normal(place.lat, place.lon));
    const auto pixel = opened->planner->pixel_at({.lon_deg = place.lon.deg(), .row_deg = row_deg});
    if (!pixel) return pixel.error();
    const CrsPoint at = *pixel;
    if (!std::isfinite(at.x) || !std::isfinite(at.y)) continue;
    const CrsPoint point = from.to_crs.at(at.x, at.y);
    for (auto part = from.parts.rbegin(); part != from.parts.rend(); ++part) {
      if (!is_near(index_.files[static_cast<std::size_t>(part->file)].file, *part, at)) continue;
      const Affine& to_crs = index_.files[static_cast<std::size_t>(part->file)].place.at.to_crs;
      auto value = value_in(rasters_, part->file, to_crs, point);
      if (value || value.error().kind == MissingKind::broken) return value;
    }
  }
  return TileFailure{MissingKind::blank, "no data"};
}

}  // namespace terrella
