#include "apps/open_scene/open_picture.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "apps/open_scene/open_cache.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/process/console.h"
#include "apps/process/progress.h"
#include "apps/process/stop_signals.h"
#include "streaming/cut/cut_plan.h"
#include "streaming/cut/growing/growing_cut.h"
#include "streaming/cut/input/picture_place.h"
#include "streaming/raster/picture_kind.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/warp/direct_tiles.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using Tiles = std::shared_ptr<TileSource>;

/// A folder inside the system's temporary folder; the destructor removes the folder with its contents.
class ScratchFolder {
 public:
  explicit ScratchFolder(fs::path path) : path_(std::move(path)) {}
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

Result<std::unique_ptr<ScratchFolder>> make_scratch_folder() {
  std::error_code failed;
  std::string name = (fs::temp_directory_path(failed) / "terrella-XXXXXX").string();
  if (failed || mkdtemp(name.data()) == nullptr) {
    return Error{
        fmt::format("{}: cannot make a temporary folder there; set TMPDIR to a folder that can be written", name)};
  }
  return std::make_unique<ScratchFolder>(name);
}

/// Keeps the scratch folder while its tiles are read. Members are destroyed last to first: tiles, then folder.
struct ScratchTiles {
  std::unique_ptr<ScratchFolder> folder;
  Tiles tiles;
};

void print_remark(const std::string& remark) { print_message("terrella: {}\n", remark); }

std::string body_text(const SourceOptions& options) {
  return options.body && options.body->name != earth().name ? options.body->name : std::string();
}

/// The cut compares the given body, latitudes and place with the picture's own.
CutOptions cut_options(const fs::path& picture, const SourceOptions& options, bool is_numbers) {
  CutOptions cut;
  cut.body = body_text(options);
  cut.latitude = options.latitude;
  set_place(cut, options.place);
  set_numbers(cut, options.numbers, is_numbers);
  cut.remark = print_remark;
  cut.images = {picture};
  cut.name = picture.stem().string();
  return cut;
}

/// Cuts a picture into a folder, and waits for the end.
Result<Tiles> cut_and_open(CutOptions cut, const fs::path& folder, const CutProgress& told) {
  Progress progress("cutting " + cut.images.front().filename().string());
  cut.progress = told ? told : [&progress](std::int64_t done, std::int64_t total) {
    progress.show(done, total);
    return !StopSignals::came();
  };
  const auto path = cut_into_cache(cut, folder);
  if (!path) return path.error();
  auto tiles = open_tile_set(*path);
  if (!tiles) return tiles.error();
  return Tiles(*std::move(tiles));
}

/// Cuts a picture into a folder, or begins to.
Result<Tiles> cut_into(CutOptions cut, const fs::path& folder, const SourceOptions& options, const CutProgress& told) {
  if (options.cuts == nullptr) return cut_and_open(std::move(cut), folder, told);
  const auto path = cache_path(cut, folder);
  if (!path) return path.error();
  std::error_code failed;
  if (fs::is_regular_file(*path, failed)) return cut_and_open(std::move(cut), folder, told);
  if (!can_write_into(folder)) return Error{fmt::format("{}: nothing can be written there", folder.string())};
  auto growing = GrowingCut::start(cut, folder);
  if (!growing) return growing.error();
  if (!*growing) return cut_and_open(std::move(cut), folder, told);
  options.cuts->push_back(*growing);
  return Tiles(*std::move(growing));
}

/// Opens a raster that shows at once. Its tiles are on the grid of its cut, so that its pixels are copied.
Result<DirectFile> open_in_place(const PictureFile& raster, const CutOptions& cut, const SourceOptions& options) {
  auto grid = grid_of_pixels(cut, raster);
  if (!grid) return grid.error();
  if (*grid) (*grid)->reduced = false;
  DirectOptions direct{cut.body, options.latitude, options.place, *grid, {}};
  set_numbers(direct.reading, cut);
  return open_direct(raster, direct);
}

/// Opens the picture where it lies; no tiles if it must be cut. Sets how it is cut.
Result<DirectFile> try_in_place(const fs::path& picture, const SourceOptions& options, CutOptions& cut) {
  std::optional<PictureFile> raster;
  if (picture_kind(picture) == PictureKind::raster) {
    auto file = measure_raster(picture);
    if (!file) return file.error();
    raster = *std::move(file);
  }
  cut = cut_options(picture, options, raster && holds_numbers(*raster->raster));
  cut.picture = raster;
  if (!options.body) set_stated_body(cut);
  return raster ? open_in_place(*raster, cut, options) : Result<DirectFile>(DirectFile{});
}

}  // namespace

Result<Tiles> open_picture(const fs::path& picture, const SourceOptions& options, const CutProgress& told) {
  CutOptions cut;
  auto direct = try_in_place(picture, options, cut);
  if (!direct) return direct.error();
  if (direct->tiles) {
    std::ranges::for_each(direct->remarks, print_remark);
    return Tiles(std::move(direct->tiles));
  }
  if (options.cache != "off") {
    const auto folder = picture_cache_folder(options.cache);
    auto kept = folder ? cut_into(cut, *folder, options, told) : Result<Tiles>(folder.error());
    if (kept || (folder && can_write_into(*folder))) return kept;
    say_without_cache(kept.error());
  }
  auto scratch = make_scratch_folder();
  if (!scratch) return scratch.error();
  auto tiles = cut_into(std::move(cut), (*scratch)->path(), options, told);
  if (!tiles) return tiles.error();
  // The tiles share the life of their folder.
  const auto both = std::make_shared<ScratchTiles>(ScratchTiles{*std::move(scratch), *std::move(tiles)});
  return Tiles(both, both->tiles.get());
}

void set_place(CutOptions& cut, const PlaceWords& words) {
  cut.crs = words.crs;
  cut.west_deg = words.west_deg;
  cut.crs_bounds = words.bounds;
}

void set_numbers(CutOptions& cut, const NumberOptions& options, bool holds_numbers) {
  if (options.bands) {
    cut.composite = CutBands{.bands = *options.bands, .stretch = {}, .nodata = options.nodata};
    for (std::size_t c = 0; c < 3 && !options.stretch.empty(); ++c) {
      cut.composite->stretch[c] = options.stretch[std::min(c, options.stretch.size() - 1)];
    }
  } else if (options.ask_for_numbers() || (!cut.format && holds_numbers)) {
    cut.numbers = CutNumbers{.band = std::max(1, options.band), .nodata = options.nodata};
  }
}

void set_numbers(RasterOptions& reading, const CutOptions& cut) {
  if (cut.numbers) {
    reading.nodata = cut.numbers->nodata;
    reading.heights = true;
    reading.stored = true;
    // Several bands are gray pictures too, and the first of them is shown.
    reading.band = cut.numbers->band;
  }
  if (!cut.composite) return;
  reading.nodata = cut.composite->nodata;
  reading.composite = composite_of(*cut.composite);
}

}  // namespace terrella
