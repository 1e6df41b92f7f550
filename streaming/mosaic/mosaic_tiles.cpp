#include "streaming/mosaic/mosaic_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <utility>

#include "base/hash_mix.h"
#include "streaming/mosaic/overview.h"
#include "streaming/mosaic/sheet_raster.h"
#include "streaming/mosaic/sheet_tiles.h"
#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

/// A tile of more files, or of more pixels of theirs, is made of the four tiles under it, and kept.
constexpr std::size_t kMostFiles = 12;
constexpr double kMostPixels = 4e6;
/// Increase this number if the pixels of overview tiles change.
constexpr std::uint64_t kOverviewVersion = 1;

double degrees_of_metres(const Body& body, double metres) {
  return metres / (body.ellipsoid.a_m() * std::numbers::pi / 180.0);
}

Result<std::unique_ptr<MosaicStore>> open_mosaic_store(const std::filesystem::path& path) {
  if (path.empty()) return std::unique_ptr<MosaicStore>();
  auto store = MosaicStore::open(path);
  if (store) return store;
  // Everything in it can be made again.
  remove_database(path);
  return MosaicStore::open(path);
}

/// The bounds on whole pixels of the grid.
GeoRect bounds_of(const MosaicBox& area, double pixel_deg) {
  constexpr double kRounding_px = 1e-3;
  const auto down = [&](double deg, double origin) {
    return origin + std::floor((deg - origin) / pixel_deg + kRounding_px) * pixel_deg;
  };
  const auto up = [&](double deg, double origin) {
    return origin + std::ceil((deg - origin) / pixel_deg - kRounding_px) * pixel_deg;
  };
  const double west = down(area.west, -180.0), east = up(area.east, -180.0);
  GeoRect bounds{.south = Angle::degrees(std::max(down(area.south, 90.0), -90.0)),
                 .north = Angle::degrees(std::min(up(area.north, 90.0), 90.0))};
  if (east - west >= 360.0 - 0.5 * pixel_deg) return bounds;
  bounds.west = Angle::degrees(std::max(west, -180.0));
  bounds.east = Angle::degrees(east > 180.0 ? east - 360.0 : east);
  return bounds;
}

Result<TileGrid> grid_of(const MosaicIndex& index, const MosaicOptions& options, const std::string& where) {
  const WarpOptions warp{.figure = {options.figure.body.ellipsoid, index.latitude, index.latitude},
                         .body = options.body,
                         .tile_px = options.tile_px};
  // The last sheet is the finest.
  auto grid = warp_grid(raster_info_of(index.sheets.back(), index.numbers), warp, where);
  if (!grid || index.sheets.size() == 1) return grid;
  const double pixel_deg = tile_span_deg(*grid, grid->max_level) / grid->tile_px;
  grid->bounds = bounds_of(area_of(index.files), pixel_deg);
  return grid;
}

class Mosaic : public MosaicTiles {
 public:
  Mosaic(MosaicIndex index, const TileGrid& grid, TileSetInfo info, std::unique_ptr<MosaicStore> store,
         const MosaicOptions& options)
      : index_(std::move(index)),
        info_(std::move(info)),
        body_(options.figure.body),
        store_(std::move(store)),
        rasters_(index_.files, {.reading = options.reading,
                                .numbers = index_.numbers,
                                .heights = options.pixels == MosaicPixels::heights,
                                .most_open = options.most_open,
                                .work_folder = options.work_folder,
                                .left_out = options.left_out,
                                .remark = options.remark}),
        sheets_(index_, rasters_, grid, options.figure.body),
        overview_({.tile_px = grid.tile_px,
                   .numbers = index_.numbers,
                   .store = store_.get(),
                   .begin =
                       [remark = options.remark, count = index_.files.size(), name = info_.name] {
                         if (remark)
                           remark(fmt::format("{}: the overview of {} files is made now, and kept", name, count));
                       },
                   .look = [this](const TileId& id) { return look(id); },
                   .make_direct = [this](const TileId& id) { return make_direct(id, files_under(id)); }}) {}

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the tile set"};
    const std::vector<int> files = files_under(id);
    if (files.empty()) return nothing();
    if (!is_direct(id, files)) return overview_.read(id, mark_of(files));
    auto tile = make_direct(id, files);
    return !tile && tile.error().kind == MissingKind::blank ? nothing() : std::move(tile);
  }

  [[nodiscard]] RemoteTiles* remote() override { return &overview_.remote(); }

  [[nodiscard]] Result<double, TileFailure> value_at(const Geodetic& place, const Ellipsoid& figure) override {
    const double row = row_latitude_deg(info_.grid, figure, Ellipsoid::normal(place.lat, place.lon));
    const double lon = place.lon.deg();
    // Boxes are rounded; a pixel more leaves out no file that has the place.
    const double near = tile_span_deg(info_.grid, info_.grid.max_level) / info_.grid.tile_px;
    return sheets_.value_at(place, figure,
                            sheets_of(index_.files_in({lon - near, row - near, lon + near, row + near})));
  }

  [[nodiscard]] MosaicFacts facts() const override {
    MosaicFacts facts = facts_of(index_);
    facts.left_out += rasters_.unreadable();
    return facts;
  }
  [[nodiscard]] int times_opened() const override { return rasters_.times_opened(); }

 private:
  [[nodiscard]] std::vector<int> files_under(const TileId& id) const {
    const TileBounds at = tile_bounds(info_.grid, id);
    return index_.files_in({at.west_deg, at.south_deg, at.east_deg, at.north_deg});
  }

  /// A tile between the files: clear pixels, or numbers without data, so that nothing coarser stands in.
  [[nodiscard]] EncodedTile nothing() const {
    const int side = info_.grid.tile_px;
    const std::size_t pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    EncodedTile tile;
    if (index_.numbers) {
      tile.make_numbers = [side, pixels]() -> Result<Numbers, TileFailure> {
        return Numbers{side, side, std::vector<float>(pixels, std::numeric_limits<float>::quiet_NaN())};
      };
    } else {
      tile.make_picture = [side, pixels]() -> Result<Image, TileFailure> {
        return Image{side, side, std::vector<std::uint8_t>(pixels * 4)};
      };
    }
    return tile;
  }

  /// The pixels of a file that a tile is made of.
  [[nodiscard]] double pixels_under(const TileId& id, const PlacedFile& file) const {
    const TileBounds at = tile_bounds(info_.grid, id);
    const double pixel_deg = degrees_of_metres(body_, file.place.pixel_units * file.place.unit_m);
    const double coarser = (at.north_deg - at.south_deg) / info_.grid.tile_px / pixel_deg;
    const int halvings = std::clamp(static_cast<int>(std::floor(std::log2(std::max(coarser, 1.0)) + 0.1)), 0, 40);
    const auto& [width, height] = file.file.sizes[static_cast<std::size_t>(level_for(file.file, halvings))];
    const double part = file.place.box.shared_area({at.west_deg, at.south_deg, at.east_deg, at.north_deg}) /
                        std::max(file.place.box.area(), 1e-12);
    return part * static_cast<double>(width) * static_cast<double>(height);
  }

  [[nodiscard]] bool is_direct(const TileId& id, const std::vector<int>& files) const {
    if (id.level >= info_.grid.max_level) return true;
    if (files.size() > kMostFiles) return false;
    double pixels = 0.0;
    for (const int file : files) pixels += pixels_under(id, index_.files[static_cast<std::size_t>(file)]);
    return pixels <= kMostPixels;
  }

  [[nodiscard]] Result<EncodedTile, TileFailure> make_direct(const TileId& id, const std::vector<int>& files) {
    return sheets_.make(id, sheets_of(files));
  }

  [[nodiscard]] std::vector<int> sheets_of(const std::vector<int>& files) const {
    std::vector<int> sheets;
    for (const int file : files) sheets.push_back(index_.sheet_of[static_cast<std::size_t>(file)]);
    std::ranges::sort(sheets);
    sheets.erase(std::unique(sheets.begin(), sheets.end()), sheets.end());
    return sheets;
  }

  [[nodiscard]] std::uint64_t mark_of(const std::vector<int>& files) const {
    std::uint64_t mark = name_hash(fmt::format("{}|{:a}|{}|{}|{}", kOverviewVersion, info_.grid.root_span_deg,
                                               info_.grid.tile_px, info_.grid.max_level, index_.numbers));
    for (const int file : files) mark = mix_bits(mark ^ index_.files[static_cast<std::size_t>(file)].mark);
    return mark;
  }

  [[nodiscard]] OverviewTile look(const TileId& id) const {
    if (!exists(info_.grid, id)) return {.is_empty = true};
    const std::vector<int> files = files_under(id);
    return {.is_empty = files.empty(), .is_direct = is_direct(id, files), .mark = mark_of(files)};
  }

  const MosaicIndex index_;
  const TileSetInfo info_;
  const Body body_;
  const std::unique_ptr<MosaicStore> store_;
  OpenRasters rasters_;
  SheetTiles sheets_;
  Overview overview_;  ///< last: its threads use the members above
};

/// Names the files that are left out: a few of them, and how many more.
void name_left_out(const MosaicIndex& index, const MosaicList& list, const std::string& where,
                   const MosaicOptions& options) {
  constexpr std::size_t kNamed = 10;
  if (options.left_out) options.left_out(static_cast<int>(index.left_out.size() + list.remarks.size()));
  if (!options.remark) return;
  for (std::size_t i = 0; i < std::min(kNamed, list.remarks.size()); ++i) options.remark(list.remarks[i]);
  if (list.remarks.size() > kNamed) options.remark(fmt::format("{}: and {} more", where, list.remarks.size() - kNamed));
  if (index.left_out.empty()) return;
  options.remark(fmt::format("{}: {} of {} files are left out:", where, index.left_out.size(),
                             index.left_out.size() + index.files.size()));
  for (std::size_t i = 0; i < std::min(kNamed, index.left_out.size()); ++i) options.remark(index.left_out[i]);
  if (index.left_out.size() > kNamed) {
    options.remark(fmt::format("{}: and {} more", where, index.left_out.size() - kNamed));
  }
}

}  // namespace

Result<std::unique_ptr<MosaicTiles>> open_mosaic(const MosaicList& list, const std::string& where,
                                                 const MosaicOptions& options) {
  auto store = open_mosaic_store(options.store);
  if (!store && options.remark) options.remark(store.error().message + "; the overview of the files is not kept");
  auto kept = store ? *std::move(store) : std::unique_ptr<MosaicStore>();
  auto index = index_mosaic(
      list, where,
      {.pixels = options.pixels, .figure = options.figure, .reading = options.reading, .jobs = options.jobs},
      kept.get());
  if (!index) return index.error();
  const auto grid = grid_of(*index, options, where);
  if (!grid) return grid.error();
  name_left_out(*index, list, where, options);
  TileSetInfo info;
  info.name = list.name;
  info.attribution = list.attribution;
  info.body = options.body;
  info.grid = *grid;
  info.format = ImageFormat::png;
  if (index->numbers) {
    const bool heights = options.pixels == MosaicPixels::heights;
    info.numbers = NumberInfo{.floats = true};
    info.numbers->unit = heights ? "m" : index->files.front().file.unit;
    if (heights) info.numbers->quantity = "height";
  }
  return std::unique_ptr<MosaicTiles>(
      std::make_unique<Mosaic>(*std::move(index), *grid, std::move(info), std::move(kept), options));
}

Result<std::unique_ptr<MosaicTiles>> open_mosaic(const std::filesystem::path& path, const MosaicOptions& options) {
  std::filesystem::path unpacked = options.store;
  if (!unpacked.empty()) unpacked.replace_extension(".files");
  const auto list = read_mosaic_list(path, unpacked);
  if (!list) return list.error();
  return open_mosaic(*list, path.string(), options);
}

}  // namespace terrella
