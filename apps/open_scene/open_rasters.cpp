#include "apps/open_scene/open_rasters.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/open_scene/open_cache.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/process/console.h"
#include "apps/process/open_files.h"
#include "base/hash_mix.h"
#include "geo/longitudes.h"
#include "streaming/cut/input/picture_place.h"
#include "streaming/cut/input/picture_raster.h"
#include "streaming/remote/web_address.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Files that stay open. Each may have overviews and a mask in files of their own.
constexpr int kMostOpen = 32;
constexpr int kFilesOfRaster = 3;

std::atomic<int>& left_out() {
  static std::atomic<int> count = 0;
  return count;
}

/// The file in the cache folder for a mosaic's headers and overview; empty without a cache.
fs::path store_file(const SourceOptions& options, const fs::path& input, MosaicPixels pixels) {
  if (options.cache == "off") return {};
  const auto folder = picture_cache_folder(options.cache);
  if (!folder || !can_write_into(*folder)) {
    say_without_cache(folder ? Error{folder->string() + ": cannot be written"} : folder.error());
    return {};
  }
  std::error_code failed;
  const fs::path whole = fs::weakly_canonical(input, failed);
  constexpr std::size_t kMaxStemBytes = 80;
  const std::string stem = whole.has_filename() ? whole.stem().string() : whole.parent_path().stem().string();
  return *folder / fmt::format("{}-{:016x}.mosaic", stem.substr(0, kMaxStemBytes),
                               name_hash(fmt::format("{}|{}", whole.string(), static_cast<int>(pixels))));
}

MosaicOptions mosaic_options(const SourceOptions& options, const fs::path& input, MosaicPixels pixels) {
  MosaicOptions mosaic;
  mosaic.pixels = pixels;
  if (options.body) mosaic.figure.body = *options.body;
  if (options.body && options.body->name != earth().name) mosaic.body = options.body->name;
  mosaic.figure.latitude = options.latitude;
  mosaic.reading = {.measure = measure_picture, .open = open_picture_raster};
  mosaic.most_open = std::max(1, connections_that_fit(kMostOpen * kFilesOfRaster) / kFilesOfRaster);
  mosaic.store = store_file(options, input, pixels);
  mosaic.remark = [](const std::string& reason) { print_message("terrella: {}\n", reason); };
  mosaic.left_out = [](int files) { left_out() += files; };
  return mosaic;
}

/// Heights with tiles of 0 m beyond their bounds.
class LevelGround : public TileSource {
 public:
  explicit LevelGround(std::shared_ptr<TileSource> heights)
      : heights_(std::move(heights)), within_(heights_->info().grid), info_(heights_->info()) {
    info_.grid.bounds = GeoRect{};
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] RemoteTiles* remote() override { return heights_->remote(); }
  [[nodiscard]] Result<double, TileFailure> value_at(const Geodetic& place, const Ellipsoid& figure) override {
    return heights_->value_at(place, figure);
  }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (exists(within_, id) || !exists(info_.grid, id)) return heights_->read(id);
    EncodedTile tile;
    tile.make_numbers = [side = info_.grid.tile_px]() -> Result<Numbers, TileFailure> {
      const std::size_t pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
      return Numbers{side, side, std::vector<float>(pixels, std::numeric_limits<float>::quiet_NaN())};
    };
    return tile;
  }

 private:
  const std::shared_ptr<TileSource> heights_;
  const TileGrid within_;
  TileSetInfo info_;
};

}  // namespace

bool names_mosaic(const Url& tile_set) {
  return !has_scheme(tile_set.with_secrets()) && is_mosaic(tile_set.with_secrets());
}

Result<std::unique_ptr<MosaicTiles>> open_many_rasters(const SourceOptions& options, MosaicPixels pixels) {
  const fs::path input = options.address.with_secrets();
  if (options.place != PlaceWords{}) {
    return Error{fmt::format(
        "{}: --crs, --bounds and --west place one picture, and this names many; write a JSON file with \"mosaic\": "
        "[{{\"file\": …, \"crs\": …, \"bounds\": …}}] (streaming/mosaic/README.md)",
        input.string())};
  }
  auto tiles = open_mosaic(input, mosaic_options(options, input, pixels));
  if (tiles && options.opened != nullptr) options.opened->many.insert_or_assign(input.string(), (*tiles)->facts());
  return tiles;
}

Result<std::unique_ptr<MosaicTiles>> open_height_raster(const SourceOptions& options) {
  const fs::path input = options.address.with_secrets();
  RasterOptions reading;
  reading.heights = true;
  // A picture in colours is refused before anything is drawn.
  if (const auto tried = open_picture_raster(input, CrsPlace{}, reading); !tried) return tried.error();
  MosaicList list;
  list.name = input.stem().string();
  list.entries.push_back({.path = input});
  MosaicOptions mosaic = mosaic_options(options, input, MosaicPixels::heights);
  mosaic.figure.may_be_planet = true;
  return open_mosaic(list, input.string(), mosaic);
}

std::shared_ptr<TileSource> with_level_ground(std::shared_ptr<TileSource> heights) {
  const GeoRect& bounds = heights->info().grid.bounds;
  const bool whole = bounds == GeoRect{};
  if (whole) return heights;
  return std::make_shared<LevelGround>(std::move(heights));
}

int rasters_left_out() { return left_out(); }

}  // namespace terrella
