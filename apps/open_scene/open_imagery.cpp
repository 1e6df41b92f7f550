#include "apps/open_scene/open_imagery.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "apps/open_scene/dated_files.h"
#include "apps/open_scene/open_cache.h"
#include "apps/open_scene/open_picture.h"
#include "apps/open_scene/open_rasters.h"
#include "apps/open_scene/open_remote.h"
#include "apps/open_scene/passed_tiles.h"
#include "apps/process/console.h"
#include "apps/process/data_dir.h"
#include "apps/process/user_folder.h"
#include "codecs/image.h"
#include "streaming/file_bytes.h"
#include "streaming/georeference/figure.h"
#include "streaming/georeference/length_unit.h"
#include "streaming/raster/picture_kind.h"
#include "streaming/raster/tiff_tags.h"
#include "streaming/remote/describe_remote.h"
#include "streaming/remote/web_address.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/warp/web_mercator.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// A tile set whose description is overridden by the command line.
class DescribedSource : public PassedTiles {
 public:
  using PassedTiles::PassedTiles;
  [[nodiscard]] Result<std::unique_ptr<TileSource>> at_time(UtcTime time) override {
    auto other = tiles().at_time(time);
    if (!other) return other.error();
    TileSetInfo changed = info();
    changed.time = (*other)->info().time;
    changed.instant = (*other)->info().instant;
    return std::unique_ptr<TileSource>(std::make_unique<DescribedSource>(*std::move(other), std::move(changed)));
  }
};

/// Stops a cut that takes longer than a user waits for the next date.
CutProgress short_cut() {
  constexpr std::chrono::seconds kMost(2);
  return [until = std::chrono::steady_clock::now() + kMost](std::int64_t /*done*/, std::int64_t /*total*/) {
    return std::chrono::steady_clock::now() < until;
  };
}

/// Opens the files of a pattern with {time}. A file of a later time that must be cut shows while it is cut, if the
/// first one may.
Result<std::shared_ptr<TileSource>> open_files_of_times(const SourceOptions& options, const CutProgress& told) {
  const fs::path pattern = options.address.with_secrets();
  if (!options.remote.times.empty()) {
    return Error{pattern.string() + ": the names of the files say their times; leave --layer-times out"};
  }
  const auto files = find_dated_files(pattern);
  if (!files) return files.error();
  auto open = [one = options, first = &told,
               grows = options.cuts != nullptr](const fs::path& file) mutable -> Result<std::shared_ptr<TileSource>> {
    std::vector<std::shared_ptr<GrowingCut>> cuts;  // the tiles own them
    const CutProgress* progress = std::exchange(first, nullptr);
    if (progress == nullptr) one.cuts = grows ? &cuts : nullptr;
    one.address = Url(file.string());
    auto tiles = open_any_tiles(one, progress != nullptr ? *progress : grows ? short_cut() : CutProgress());
    one.opened = nullptr;  // those of the opening end with it
    if (tiles || progress != nullptr || !grows) return tiles;
    return Error{tiles.error().message + "; a file that does not show at once is cut with terrella cut first"};
  };
  return open_dated_files(pattern.string(), *files, options.remote.time, std::move(open));
}

Result<std::shared_ptr<TileSource>> open_named(const SourceOptions& options, const CutProgress& told) {
  if (names_mosaic(options.address)) {
    auto tiles = open_many_rasters(options, MosaicPixels::as_stored);
    if (!tiles) return tiles.error();
    return std::shared_ptr<TileSource>(*std::move(tiles));
  }
  if (is_remote(options.address)) return open_remote(options);
  if (names_dated_files(options.address)) return open_files_of_times(options, told);
  if (const Status found = find_imagery(options); !found) return found.error();
  const fs::path path = options.address.empty() ? data_file("earth.gpkg") : fs::path(options.address.with_secrets());
  const bool said_geodetic = options.projection == Projection::equirectangular;
  const bool picture = is_picture(path);
  if (!picture && options.place != PlaceWords{}) {
    return Error{
        fmt::format("{}: --crs, --bounds and --west place a picture, and this is a tile set, which says itself "
                    "where it lies; leave them out",
                    path.string())};
  }
  const NumberOptions& numbers = options.numbers;
  if (!picture && (numbers.bands || numbers.band > 0 || numbers.nodata)) {
    return Error{
        fmt::format("{}: --band, --bands and --nodata choose what is read of a TIFF, and this is a tile set; "
                    "leave them out",
                    path.string())};
  }
  if (picture) return open_picture(path, options, told);
  auto tiles = open_tile_set(path, said_geodetic);
  if (!tiles) return tiles.error();
  return std::shared_ptr<TileSource>(*std::move(tiles));
}

/// Options for opening the heights, whose cache stands beside a given --cache.
SourceOptions heights_options(const SceneOptions& options) {
  SourceOptions heights = options_beside(options.base, options.elevation);
  heights.numbers.heights = true;
  const std::string& given = options.base.cache;
  if (!given.empty() && given != "off") {
    const fs::path cache = given;
    heights.cache = (cache.parent_path() / (cache.stem().string() + "-heights.gpkg")).string();
  }
  return heights;
}

/// `field` is the field of a description for the address.
Error no_meaning(const Url& address, const char* field) {
  return Error{fmt::format(
      "{}: nothing says what the numbers in its tiles mean in metres; write a description that does, for example "
      "heights.json with {{\"{}\": \"…\", \"max_level\": 8, \"elevation\": {{\"scale\": 1, \"offset\": -32768}}}}, and "
      "give "
      "--elevation heights.json (streaming/remote/README.md)",
      address.redacted(), field)};
}

}  // namespace

bool is_picture(const fs::path& path) {
  if (picture_kind(path) != PictureKind::none) return true;
  std::error_code failed;
  if (!fs::is_regular_file(path, failed)) return false;
  const std::string extension = lower_extension(path);
  constexpr std::array kExtensions = {".jpg", ".jpeg", ".png", ".webp", ".tif", ".tiff"};
  return std::ranges::find(kExtensions, extension) != kExtensions.end();
}

Result<fs::path> picture_cache_folder(const std::string& cache) {
  if (!cache.empty()) {
    const fs::path path = cache;
    if (path.extension() == ".gpkg") return path.parent_path() / (path.stem().string() + "-pictures");
    return path;
  }
  if (const auto folder = user_folder("XDG_CACHE_HOME", ".cache")) return *folder;
  return Error{"no place for the cache: neither XDG_CACHE_HOME nor HOME is set; set one or give --cache"};
}

Status find_imagery(const SourceOptions& options) {
  if (is_remote(options.address) || names_mosaic(options.address) || names_dated_files(options.address)) return Done{};
  const fs::path path = options.address.empty() ? data_file("earth.gpkg") : fs::path(options.address.with_secrets());
  std::error_code failed;
  if (!fs::exists(file_of(path), failed)) return Error{fmt::format("{}: no such file or folder", path.string())};
  return fs::is_directory(path, failed) ? Status(Done{}) : check_regular(path);
}

std::string name_of(const SourceOptions& options) {
  return options.address.empty() ? "the included Earth" : options.address.redacted();
}

/// Fails if the tiles are of another body than the globe.
Status check_body(const SourceOptions& options, const TileSetInfo& info) {
  if (!options.body || info.body.empty()) return Done{};
  const auto said = parse_body(info.body);
  if (said && !are_two_bodies(*said, *options.body)) return Done{};
  const std::string radius = said ? fmt::format(" (radius {:.0f} m)", said->ellipsoid.a_m()) : std::string();
  return Error{fmt::format("{}: its tiles are of the body {}{}, and the globe is {} (radius {:.0f} m); {}",
                           name_of(options), info.body, radius, options.body->name, options.body->ellipsoid.a_m(),
                           options.address.empty() ? "name a tile set of that body"
                                                   : "say which it is with --body, or leave this tile set out")};
}

Result<std::shared_ptr<TileSource>> open_any_tiles(const SourceOptions& said, const CutProgress& progress) {
  SourceOptions options = said;
  if (said.other_body) options.body.reset();
  auto tiles = open_named(options, progress);
  if (!tiles) return tiles.error();
  TileSetInfo info = (*tiles)->info();
  if (Status same = check_body(options, info); !same) return same.error();
  for (const std::string& remark : info.remarks) print_message("terrella: {}\n", remark);
  const bool mercator = info.made_of && info.made_of->projection == Projection::web_mercator;
  if (options.projection && mercator != (*options.projection == Projection::web_mercator)) {
    return Error{name_of(options) + (mercator
                                         ? ": it is in Web Mercator, and --projection says otherwise; leave that out"
                                         : ": it is not in Web Mercator by what it says of itself, as --projection "
                                           "says; leave that out")};
  }
  info.attribution = options.remote.attribution.value_or(info.attribution);
  if (!mercator) {
    info.grid.projection = options.projection.value_or(info.grid.projection);
    info.grid.latitude = options.latitude.value_or(info.grid.latitude);
  }
  if (info.grid == (*tiles)->info().grid && info.attribution == (*tiles)->info().attribution) return tiles;
  return std::shared_ptr<TileSource>(std::make_shared<DescribedSource>(*std::move(tiles), std::move(info)));
}

Result<std::shared_ptr<TileSource>> open_imagery(const SourceOptions& options) {
  auto tiles = open_any_tiles(options);
  if (!tiles || !(*tiles)->info().numbers) return tiles;
  return Error{
      fmt::format("{0}: its tiles are numbers, not pictures; name them as TILESET or with --overlay, or heights with "
                  "--elevation {0}",
                  options.address.redacted())};
}

/// Opens tiles whose numbers are in colours, as --elevation-encoding says.
Result<std::shared_ptr<TileSource>> open_encoded(SourceOptions heights, const NumberInfo& encoding) {
  if (is_remote(heights.address)) {
    heights.remote.numbers = encoding;
    return open_remote(heights);
  }
  auto stored = open_stored_tile_set(heights.address.with_secrets());
  if (!stored) return stored.error();
  TileSetInfo info = (*stored)->info();
  info.numbers = encoding;
  auto tiles =
      as_geodetic(std::make_unique<DescribedSource>(*std::move(stored), std::move(info)), heights.address.redacted());
  if (!tiles) return tiles.error();
  return std::shared_ptr<TileSource>(*std::move(tiles));
}

/// Opens the tiles of --elevation: of a tile set, of a raster, or of many.
Result<std::shared_ptr<TileSource>> open_height_tiles(const SceneOptions& options) {
  const SourceOptions heights = heights_options(options);
  const bool many = names_mosaic(heights.address);
  if (many || is_picture(heights.address.with_secrets())) {
    auto tiles = many ? open_many_rasters(heights, MosaicPixels::heights) : open_height_raster(heights);
    if (!tiles) return tiles.error();
    return std::shared_ptr<TileSource>(*std::move(tiles));
  }
  if (options.elevation_encoding) return open_encoded(heights, *options.elevation_encoding);
  // Fails without a request: only a description states the meaning of a server's numbers.
  if (options.elevation.with_secrets().find("{z}") != std::string::npos) return no_meaning(options.elevation, "url");
  auto tiles = open_any_tiles(heights);
  if (tiles && is_remote(options.elevation) && !(*tiles)->info().numbers) return no_meaning(options.elevation, "wmts");
  return tiles;
}

/// The same heights in metres, if their unit is another length.
std::shared_ptr<TileSource> in_metres(std::shared_ptr<TileSource> heights) {
  TileSetInfo info = heights->info();
  const auto unit_m = info.numbers ? metres_of_unit(info.numbers->unit) : std::nullopt;
  if (!unit_m || info.numbers->unit.empty() || info.numbers->unit == "m") return heights;
  info.numbers->unit = "m";
  info.numbers->scale *= *unit_m;
  info.numbers->offset *= *unit_m;
  return std::make_shared<DescribedSource>(std::move(heights), std::move(info));
}

Result<std::optional<ElevationSource>> open_elevation(const SceneOptions& options) {
  if (options.elevation.empty()) {
    if (options.exaggeration != 1.0) {
      print_message(
          "terrella: --exaggeration multiplies heights, and there are none; give them with --elevation, or leave "
          "--exaggeration out\n");
    }
    return std::optional<ElevationSource>();
  }
  auto tiles = open_height_tiles(options);
  if (!tiles) return tiles.error();
  const auto& numbers = (*tiles)->info().numbers;
  if (numbers && !metres_of_unit(numbers->unit)) {
    return Error{fmt::format("{}: {}", options.elevation.redacted(), no_length(numbers->unit))};
  }
  auto source = ElevationSource::open(with_level_ground(in_metres(*std::move(tiles))), options.elevation.redacted());
  if (!source) return source.error();
  return std::optional<ElevationSource>(*std::move(source));
}

}  // namespace terrella
