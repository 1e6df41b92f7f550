#include "streaming/mosaic/open_rasters.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "streaming/georeference/length_unit.h"

namespace terrella {
namespace {

constexpr std::size_t kDecodedBytes = 12UL << 20;
/// Most memory for open files without tiles, whose pixels stay decoded.
constexpr std::size_t kOpenBytes = 96UL << 20;
/// A picture without tiles that is larger than this is decoded into a temporary file (block_store.h).
constexpr std::size_t kStoreBytes = 128UL << 20;
constexpr std::size_t kHandleBytes = 64UL << 10;
constexpr int kLevelsOfFile = 64;

std::size_t held_bytes(const MosaicFile& file) {
  if (!file.by_rows) return kHandleBytes;
  std::size_t bytes = kHandleBytes;
  for (const auto& [width, height] : file.sizes) bytes += static_cast<std::size_t>(width * height) * 4;
  return bytes > kStoreBytes ? kHandleBytes : bytes;
}

Result<Block, TileFailure> decode_block(const EncodedTile& tile) {
  if (tile.make_numbers) {
    auto numbers = tile.make_numbers();
    if (!numbers) return numbers.error();
    return Block(*std::move(numbers));
  }
  auto image = tile.make_picture();
  if (!image) return image.error();
  return Block(*std::move(image));
}

/// Options for reading a file of the mosaic.
RasterOptions raster_options(const MosaicFile& file, const OpenRasterOptions& options) {
  RasterOptions reading;
  reading.heights = options.numbers;
  reading.nodata = file.nodata;
  reading.work_folder = options.work_folder;
  const double metres = options.heights ? metres_of_unit(file.unit).value_or(1.0) : 1.0;
  reading.scale = file.scale * metres;
  reading.offset = file.offset * metres;
  return reading;
}

}  // namespace

OpenRasters::OpenRasters(const std::vector<PlacedFile>& files, OpenRasterOptions options)
    : files_(files), options_(std::move(options)), decoded_(kDecodedBytes) {}

void OpenRasters::refuse(int file, const std::string& why) {
  if (!named_.insert(file).second) return;
  ++unreadable_;
  if (options_.left_out) options_.left_out(1);
  if (options_.remark) options_.remark(why);
}

void OpenRasters::close_oldest() {
  bytes_ -= open_.back().bytes;
  places_.erase(open_.back().file);
  open_.pop_back();
}

std::shared_ptr<RasterSource> OpenRasters::open(int file) {
  // Opening takes under a millisecond, so threads wait for each other.
  const std::lock_guard lock(mutex_);
  if (const auto known = places_.find(file); known != places_.end()) {
    open_.splice(open_.begin(), open_, known->second);
    return known->second->raster;
  }
  const PlacedFile& placed = files_[static_cast<std::size_t>(file)];
  const std::size_t bytes = held_bytes(placed.file);
  while (!open_.empty() &&
         (open_.size() >= static_cast<std::size_t>(options_.most_open) || bytes_ + bytes > kOpenBytes)) {
    close_oldest();
  }
  ++times_opened_;
  auto raster = options_.reading.open(placed.file.path, placed.place.at, raster_options(placed.file, options_));
  if (!raster || (*raster)->info().levels.size() != placed.file.sizes.size()) {
    refuse(file,
           raster ? fmt::format("{}: has changed; start again", placed.file.path.string()) : raster.error().message);
    return nullptr;
  }
  open_.push_front({.file = file, .raster = *std::move(raster), .bytes = bytes});
  places_[file] = open_.begin();
  bytes_ += bytes;
  return open_.front().raster;
}

std::optional<RasterLevel> OpenRasters::level(int file, int level) {
  const auto raster = open(file);
  if (!raster) return {};
  return raster->info().levels[static_cast<std::size_t>(level)];
}

DecodedBlocks::Decoded OpenRasters::block(int file, const TileId& block) {
  const TileId key{.level = file * kLevelsOfFile + block.level, .x = block.x, .y = block.y};
  return decoded_.get(key, [&]() -> Result<Block, TileFailure> {
    const auto raster = open(file);
    if (!raster) return TileFailure{MissingKind::broken, {}};
    const auto encoded = raster->read(block);
    auto decoded = encoded ? decode_block(*encoded) : Result<Block, TileFailure>(encoded.error());
    if (decoded) return decoded;
    const std::lock_guard lock(mutex_);
    refuse(file, decoded.error().why);
    return TileFailure{MissingKind::broken, {}};
  });
}

Result<double, TileFailure> OpenRasters::value_at(int file, std::int64_t column, std::int64_t row) {
  const auto raster = open(file);
  if (!raster) return TileFailure{MissingKind::broken, "the file cannot be read"};
  return raster->value_at(column, row);
}

}  // namespace terrella
