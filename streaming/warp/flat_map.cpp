#include "streaming/warp/flat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "geo/ellipsoid.h"
#include "streaming/georeference/figure.h"
#include "streaming/raster/tile_raster.h"
#include "streaming/warp/block_fetcher.h"
#include "streaming/warp/map/pixel_map.h"
#include "streaming/warp/warp_job.h"

namespace terrella {
namespace {

constexpr std::size_t kDecodedBytes = 128UL << 20;
constexpr CrsPoint kNoPixel{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

RasterInfo raster_of(const FlatMap& map) {
  RasterInfo info;
  info.crs = map.crs;
  info.levels.push_back({.width_px = map.width_px, .height_px = map.height_px, .to_crs = map.to_crs()});
  return info;
}

/// Degrees of the ground in a pixel of a map, no less than they are nearly anywhere on it.
double pixel_deg_of(const FlatMap& map, const CrsFacts& crs) {
  constexpr double kMostStretch = 2.0;  // a pixel against the unit of its system
  const double degree_m = crs.a_m * std::numbers::pi / 180.0;
  return kMostStretch * map.unit_per_px * (crs.geographic ? crs.unit_deg : crs.unit_m / degree_m);
}

/// A tile set as the source of a map's pixels.
struct SourceGrid {
  TileGrid grid;
  Ellipsoid figure;
  Affine to_row_places;  ///< from pixels of the finest level to longitudes and row latitudes, degrees
  int block_px = FlatMapLayer::kBlock_px;
  double pixel_deg = 0.0;  ///< pixels of the map

  [[nodiscard]] CrsPoint pixel_of(const RowPlace& place) const {
    if (!std::isfinite(place.lon_deg) || !std::isfinite(place.row_deg)) return kNoPixel;
    const EcefDir normal = Ellipsoid::normal(Angle::degrees(place.row_deg), Angle::degrees(place.lon_deg));
    return {(place.lon_deg - to_row_places.x0) / to_row_places.x_per_column,
            (row_latitude_deg(grid, figure, normal) - to_row_places.y0) / to_row_places.y_per_row};
  }
};

/// Geodetic places of a block's pixels. Longitudes are the ones nearest to `middle_deg`, so that they do not jump
/// within the block unless it goes round a pole.
class BlockPlaces {
 public:
  BlockPlaces(const GroundMap& map, std::int64_t column, std::int64_t row, int block_px)
      : map_(map), left_(static_cast<double>(column * block_px)), top_(static_cast<double>(row * block_px)) {
    const CrsPoint middle{0.5 * block_px, 0.5 * block_px};
    const double lon_deg = at({&middle, 1}).front().lon_deg;
    if (std::isfinite(lon_deg)) middle_deg_ = lon_deg;
  }

  [[nodiscard]] std::vector<RowPlace> at(std::span<const CrsPoint> block_px) const {
    std::vector<CrsPoint> pixels;
    pixels.reserve(block_px.size());
    for (const CrsPoint& px : block_px) pixels.push_back({left_ + px.x, top_ + px.y});
    std::vector<RowPlace> places = map_.places(pixels);
    if (!map_.turn_px()) leave_map(pixels, places);
    for (RowPlace& place : places) place.lon_deg -= 360.0 * std::round((place.lon_deg - middle_deg_) / 360.0);
    return places;
  }

 private:
  /// Some projections give a place to points beyond their map. A map that goes on round the planet has none.
  void leave_map(std::span<const CrsPoint> pixels, std::vector<RowPlace>& places) const {
    constexpr double kSame_px = 0.5;
    std::vector<CrsPoint> back(pixels.size());
    map_.pixels(places, back);
    for (std::size_t i = 0; i < back.size(); ++i) {
      const bool same = std::hypot(back[i].x - pixels[i].x, back[i].y - pixels[i].y) < kSame_px;
      if (!same) places[i] = {kNoPixel.x, kNoPixel.y};
    }
  }

  const GroundMap& map_;
  const double left_, top_;
  double middle_deg_ = 0.0;
};

PixelMap map_of_block(const BlockPlaces& places, const SourceGrid& source) {
  PixelMap block{.tile_px = source.block_px,
                 .rows = source.block_px,
                 .pixel_deg = source.pixel_deg,
                 .pixels = {},
                 .on_ground = {}};
  block.pixels = [&places, &source](std::span<const CrsPoint> places_px, std::span<CrsPoint> out) {
    const std::vector<RowPlace> found = places.at(places_px);
    std::ranges::transform(found, out.begin(), [&](const RowPlace& place) { return source.pixel_of(place); });
  };
  // The columns of the source are narrow near its poles.
  block.on_ground = [&places](const Jacobian& pixels, double x, double y) {
    const CrsPoint at{x, y};
    const double row_deg = places.at({&at, 1}).front().row_deg;
    const double cosine = std::isfinite(row_deg) ? std::cos(row_deg * std::numbers::pi / 180.0) : 1.0;
    return GroundScale{{pixels.u_x * cosine, pixels.u_y * cosine, pixels.v_x, pixels.v_y}, 1.0};
  };
  return block;
}

/// Facts of a map's system. Fails if it is one of another body.
Result<CrsFacts> system_of(const std::string& crs, const Body& body) {
  const auto opened = Crs::open(crs);
  if (!opened) return opened.error();
  const std::string stated = stated_body(opened->facts());
  const auto its_body = parse_body(stated.empty() ? "earth" : stated);
  if (!its_body) return its_body.error();
  if (!are_two_bodies(*its_body, body)) return opened->facts();
  return Error{fmt::format("it is a system of another body ({}) than the globe's ({}); name one of the globe's body",
                           its_body->name, body.name)};
}

}  // namespace

struct FlatMapLayer::Parts {
  TileSetInfo info;
  std::shared_ptr<GroundMaps> maps;
  SourceGrid source;
  WarpFrame frame;
  std::shared_ptr<const StoredBlocks> blocks;
  std::shared_ptr<BlockFetcher> fetcher{};  ///< null: all tiles are available without requests

  [[nodiscard]] Result<WarpJob, TileFailure> job_of(const TileId& block) const {
    auto plan = maps->lend([&](const GroundMap& map) {
      const BlockPlaces places(map, block.x, block.y, source.block_px);
      return plan_tile(map_of_block(places, source), frame);
    });
    if (!plan) return plan.error();
    return WarpJob(blocks, *std::move(plan));
  }
  /// The block's recipe; waits for a server.
  [[nodiscard]] Result<EncodedTile, TileFailure> recipe_of(const TileId& block,
                                                           const std::function<bool()>& may_wait) const;
};

Result<EncodedTile, TileFailure> FlatMapLayer::Parts::recipe_of(const TileId& block,
                                                                const std::function<bool()>& may_wait) const {
  if (!fetcher) {
    auto job = job_of(block);
    if (!job) return job.error();
    job->advance();
    return job->result(info.numbers.has_value());
  }
  using Answer = Result<EncodedTile, TileFailure>;
  const auto promise = std::make_shared<std::promise<Answer>>();
  std::future<Answer> answer = promise->get_future();
  fetcher->tiles().fetch(block, 0.0, [promise](Answer come) { promise->set_value(std::move(come)); });
  constexpr std::chrono::milliseconds kBetweenLooks{100};
  do {
    if (answer.wait_for(kBetweenLooks) == std::future_status::ready) return answer.get();
  } while (may_wait());
  fetcher->tiles().cancel(block);
  return TileFailure{MissingKind::failed, "no answer in time"};
}

FlatMapLayer::FlatMapLayer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
FlatMapLayer::~FlatMapLayer() {
  if (parts_->fetcher) parts_->fetcher->close();
}

Result<std::unique_ptr<FlatMapLayer>> FlatMapLayer::open(std::shared_ptr<TileSource> tiles, const FlatMap& map,
                                                         const Body& body) {
  const auto crs = system_of(map.crs, body);
  if (!crs) return crs.error();
  auto maps = GroundMaps::open(raster_of(map), {.ellipsoid = body.ellipsoid});
  if (!maps) return maps.error();
  TileSetInfo info = tiles->info();
  std::shared_ptr<RasterSource> raster = raster_of_tiles(std::move(tiles));
  const Affine& to_row_places = raster->info().levels.back().to_crs;
  const CrsPoint turn{360.0 / to_row_places.x_per_column, 0.0};
  // Tiles of a server cost requests.
  const Detail detail = raster->remote() == nullptr ? Detail::full : Detail::usual;
  auto parts = std::make_unique<Parts>(
      Parts{.info = info,
            .maps = *std::move(maps),
            .source = {info.grid, body.ellipsoid, to_row_places, kBlock_px, pixel_deg_of(map, *crs)},
            .frame = {.levels = warp_levels(raster->info(), turn, kBlock_px, Overviews::made), .detail = detail},
            .blocks = {}});
  parts->blocks = std::make_shared<const StoredBlocks>(
      raster, parts->frame.levels, BlockNames{.noun = "tile", .first_level = info.grid.min_level}, kDecodedBytes);
  if (raster->remote() != nullptr) {
    const auto make_job = [from = parts.get()](const TileId& block) { return from->job_of(block); };
    parts->fetcher = std::make_shared<BlockFetcher>(parts->blocks, make_job, info.numbers.has_value());
  }
  return std::unique_ptr<FlatMapLayer>(new FlatMapLayer(std::move(parts)));
}

const TileSetInfo& FlatMapLayer::info() const { return parts_->info; }

Result<Block, TileFailure> FlatMapLayer::block(std::int64_t column, std::int64_t row,
                                               const std::function<bool()>& may_wait) {
  const auto recipe = parts_->recipe_of({.level = 0, .x = column, .y = row}, may_wait);
  if (!recipe) return recipe.error();
  if (parts_->info.numbers) {
    auto numbers = recipe->make_numbers();
    return numbers ? Result<Block, TileFailure>(*std::move(numbers)) : numbers.error();
  }
  auto picture = recipe->make_picture();
  return picture ? Result<Block, TileFailure>(*std::move(picture)) : picture.error();
}

}  // namespace terrella
