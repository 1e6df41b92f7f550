#include "streaming/cut/growing/growing_cut.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <new>
#include <system_error>

#include "geo/body.h"
#include "streaming/cut/bands.h"
#include "streaming/cut/growing/coarse_raster.h"
#include "streaming/cut/input/cut_input.h"
#include "streaming/cut/input/picture_place.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/warp/direct_tiles.h"
#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Priority of the cut's threads: the window comes first.
constexpr int kPriority = 10;
/// Time between two editions. Each reads the coarse tiles in view again.
constexpr std::chrono::milliseconds kBetweenEditions{1000};

std::optional<EncodedTile> read_stored(fs::path log, std::uint64_t offset, std::size_t size) {
  std::ifstream file(log, std::ios::binary);
  if (!file) file.open(log += ".part", std::ios::binary);
  EncodedTile tile;
  tile.bytes.resize(size);
  file.seekg(static_cast<std::streamoff>(offset));
  file.read(reinterpret_cast<char*>(tile.bytes.data()), static_cast<std::streamsize>(size));
  if (!file) return std::nullopt;
  return tile;
}

/// A set whose tiles on the canvas's grid are resampled from the coarse raster; null if the picture has none.
Result<std::unique_ptr<TileSource>> coarse_tiles(const CutOptions& options, const TileGrid& grid) {
  const auto picture = picture_of(options);
  if (!picture) return picture.error();
  auto place = find_place(options, *picture);
  if (!place) return place.error();
  const DirectOptions direct{.body = options.body, .latitude = place->latitude, .place = words_of(options)};
  const auto at = place_raster(std::move(place->placed), *picture, direct);
  if (!at) return at.error();
  if (!*at) return std::unique_ptr<TileSource>{};
  auto raster = open_coarse_raster(picture->path, (*at)->at, {choice_of(options), options.numbers.has_value()});
  if (!raster) return raster.error();
  if (!*raster) return std::unique_ptr<TileSource>{};
  const auto body = options.body.empty() ? Result<Body>(earth()) : parse_body(options.body);
  if (!body) return body.error();
  auto planner =
      TilePlanner::open((*raster)->info(), {body->ellipsoid, grid.latitude, grid.latitude}, grid, Overviews::stored);
  if (!planner) return planner.error();
  TileSetInfo info{.name = {}, .attribution = {}, .body = {}, .grid = grid};
  info.numbers = (*raster)->info().numbers;
  return make_warp_source(*std::move(raster), *std::move(planner), std::move(info), {}, kWarpDecodedBytes);
}

}  // namespace

GrowingCut::GrowingCut(CutOptions options, PlannedCut planned)
    : options_(std::move(options)),
      planned_(std::move(planned)),
      canvas_(planned_.plan),
      coarsest_cut_(std::max(canvas_.grid().max_level, bands_of(planned_.plan).coarsest - 1)),
      desk_({.work = [this](const TileWish& wish) { return answer(wish.id); }, .threads = 1}) {}

Result<std::shared_ptr<GrowingCut>> GrowingCut::start(CutOptions options, const fs::path& folder) {
  options.remark = {};
  auto picture = picture_of(options);
  if (!picture) return picture.error();
  options.picture = *std::move(picture);
  auto planned = plan_pictures(options);
  if (!planned) return planned.error();
  std::shared_ptr<GrowingCut> cut(new GrowingCut(std::move(options), *std::move(planned)));
  if (cut->options_.numbers) {
    TileGrid grid = cut->planned_.info.grid;
    grid.max_level = std::min(grid.max_level, cut->coarsest_cut_);
    auto coarse = coarse_tiles(cut->options_, grid);
    if (!coarse) return coarse.error();
    if (!*coarse) return std::shared_ptr<GrowingCut>();
    cut->coarse_ = *std::move(coarse);
  }
  cut->watch();
  try {
    cut->thread_ = std::thread([self = cut.get(), folder] { self->run(folder); });
  } catch (const std::system_error& failed) {
    return Error{fmt::format("{}: cannot be cut: {}", cut->picture().string(), failed.what())};
  }
  return cut;
}

GrowingCut::~GrowingCut() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

GrowingCut::State GrowingCut::state() const {
  const std::lock_guard lock(mutex_);
  return {.share = share_, .ended = whole_ != nullptr || error_, .error = error_};
}

void GrowingCut::watch() {
  options_.keep_unfinished = true;
  options_.progress = [this](std::int64_t done, std::int64_t total) {
    share_ = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 0.0;
    renew(false);
    return !stop_;
  };
  options_.watch = CutWatch{.tile_made = [this](const CutTile& tile) { keep(tile); },
                            .row_read =
                                [this](std::int64_t row, std::span<const std::uint8_t> rgba) {
                                  if (coarse_) return;  // rows of numbers
                                  canvas_.add_row(row, rgba);
                                  dirty_ = true;
                                },
                            .row_step = canvas_.row_step()};
}

/// Tells the globe about new coarse tiles, at most once in a while.
void GrowingCut::renew(bool now) {
  if (!now && (!dirty_ || Clock::now() - renewed_ < kBetweenEditions)) return;
  dirty_ = false;
  ++edition_;
  renewed_ = Clock::now();
}

void GrowingCut::run(const fs::path& folder) {
  try {
    paint_coarse();
    // Linux counts the priority by threads, and threads take it over from the thread that starts them.
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kPriority);
    const auto path = cut_into_cache(options_, folder);
    if (!path) return finish(path.error());
    auto whole = open_tile_set(*path);
    if (!whole) return finish(whole.error());
    finish(std::shared_ptr<TileSource>(*std::move(whole)));
  } catch (const std::exception& failed) {
    finish(Error{fmt::format("{}: cannot be cut: {}", picture().string(), failed.what())});
  }
}

/// A failure is left to the cut, which names it.
void GrowingCut::paint_coarse() {
  if (coarse_) return;
  const auto tiles = coarse_tiles(options_, canvas_.grid());
  if (!tiles || !*tiles) return;
  renewed_ = Clock::now();
  for (const TileId& id : canvas_.tiles()) {
    if (stop_) return;
    auto tile = (*tiles)->read(id);
    const auto image = tile && tile->make_picture ? tile->make_picture() : Result<Image, TileFailure>(TileFailure{});
    if (!image) continue;
    canvas_.paint(id, *image);
    dirty_ = true;
    renew(false);
  }
  renew(true);
}

void GrowingCut::keep(const CutTile& tile) {
  {
    const std::lock_guard lock(mutex_);
    if (logs_.empty() || logs_.back() != tile.log) logs_.push_back(tile.log);
    stored_[tile.id] = {logs_.size() - 1, tile.offset, tile.size};
  }
  if (tile.id.level <= coarsest_cut_) dirty_ = true;
  desk_.resume(tile.id);
}

void GrowingCut::finish(Result<std::shared_ptr<TileSource>> whole) {
  {
    const std::lock_guard lock(mutex_);
    if (whole) {
      whole_ = *whole;
    } else {
      error_ = whole.error();
    }
    stored_.clear();
  }
  renew(true);
  desk_.resume_all();
}

std::optional<GrowingCut::Answer> GrowingCut::find(const TileId& id) const {
  std::shared_ptr<TileSource> whole;
  Stored stored;
  fs::path log;
  {
    const std::lock_guard lock(mutex_);
    const auto found = stored_.find(id);
    whole = whole_;
    if (!whole && error_ && id.level > coarsest_cut_) return TileFailure{MissingKind::broken, error_->message};
    if (!whole && found == stored_.end()) return std::nullopt;
    if (!whole) {
      stored = found->second;
      log = logs_[stored.log];
    }
  }
  if (whole) return whole->read(id);
  auto tile = read_stored(std::move(log), stored.offset, stored.size);
  if (!tile) return std::nullopt;
  return Answer(*std::move(tile));
}

Result<EncodedTile, TileFailure> GrowingCut::read(const TileId& id) {
  if (!exists(planned_.info.grid, id)) return TileFailure{MissingKind::absent, "outside the tile set"};
  if (auto found = find(id)) return *std::move(found);
  if (id.level > coarsest_cut_) return TileFailure{MissingKind::remote, {}};
  return coarse_tile(id);
}

EncodedTile GrowingCut::coarse_tile(const TileId& id) {
  EncodedTile tile;
  if (!coarse_) {
    tile.make_picture = [this, id]() -> Result<Image, TileFailure> { return canvas_.tile(id); };
    return tile;
  }
  // The small version has values, and the set numbers.
  const NumberInfo& numbers = *planned_.info.numbers;
  tile.number_scale = 1.0 / numbers.scale;
  tile.number_offset = -numbers.offset / numbers.scale;
  tile.make_numbers = [this, id]() -> Result<Numbers, TileFailure> {
    const auto values = coarse_->read(id);
    if (!values) return values.error();
    return values->make_numbers();
  };
  return tile;
}

/// Nothing until the cut comes to the tile.
std::optional<GrowingCut::Answer> GrowingCut::answer(const TileId& id) {
  auto tile = read(id);
  if (!tile && tile.error().kind == MissingKind::remote) return std::nullopt;
  return tile;
}

}  // namespace terrella
