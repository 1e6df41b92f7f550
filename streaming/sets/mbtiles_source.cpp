#include "streaming/sets/mbtiles_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/number.h"
#include "streaming/remote/crs_names.h"
#include "streaming/remote/web_address.h"
#include "streaming/sets/directory_source.h"
#include "streaming/sets/sqlite_tiles.h"
#include "streaming/sets/tileset_json.h"
#include "streaming/tile_lister.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

constexpr std::size_t kMaxMetadata = 1000;
constexpr std::size_t kMaxValueBytes = 16384;
using Metadata = std::map<std::string, std::string>;

class MbtilesSource : public TileSource, public TileLister {
 public:
  MbtilesSource(std::filesystem::path path, TileSetInfo info, std::unique_ptr<SqliteTiles> tiles)
      : path_(std::move(path)), info_(std::move(info)), tiles_(std::move(tiles)) {}

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the tile set"};
    return tiles_->read({.zoom = id.level, .column = id.x, .row = rows(info_.grid, id.level) - 1 - id.y});
  }

  [[nodiscard]] std::optional<std::int64_t> count_tiles(int level) override { return tiles_->count(level); }

  [[nodiscard]] Status for_each_tile(const std::function<bool(const TileId&)>& call) override {
    for (int level = info_.grid.min_level; level <= info_.grid.max_level; ++level) {
      const auto more = tiles_->for_each(level, [&](std::int64_t column, std::int64_t row) {
        if (row < 0 || row >= rows(info_.grid, level)) return true;
        const TileId id{.level = level, .x = column, .y = rows(info_.grid, level) - 1 - row};
        return !exists(info_.grid, id) || call(id);
      });
      if (!more) return Error{fmt::format("{}: its tiles cannot be listed: {}", path_.string(), more.error().message)};
      if (!*more) return Done{};
    }
    return Done{};
  }

 private:
  const std::filesystem::path path_;
  const TileSetInfo info_;
  const std::unique_ptr<SqliteTiles> tiles_;
};

Result<Metadata, SqlError> read_metadata(SqliteReader& reader) {
  Result<SqliteQuery, SqlError> query = reader.prepare("SELECT name, value FROM metadata");
  if (!query) return query.error();
  Metadata metadata;
  for (std::size_t i = 0; i < kMaxMetadata; ++i) {
    const Result<bool, SqlError> more = query->step();
    if (!more) return more.error();
    if (!*more) break;
    const auto name = query->text(0);
    const auto value = query->text(1);
    if (name && value && value->size() <= kMaxValueBytes) metadata.emplace(lower_case(*name), *value);
  }
  return metadata;
}

std::string value_of(const Metadata& metadata, const std::string& name) {
  const auto found = metadata.find(name);
  return found == metadata.end() ? std::string() : found->second;
}

bool says_geodetic(const Metadata& metadata) {
  const std::string profile = lower_case(value_of(metadata, "profile"));
  if (profile == "geodetic" || profile == "global-geodetic") return true;
  return std::ranges::any_of(std::array{"crs", "srs"}, [&](const char* name) {
    const std::string crs = value_of(metadata, name);
    return !crs.empty() && parse_crs(crs).ok();
  });
}

/// Numbers returned by a query; nothing if the query takes too long, or if there are no tiles.
template <std::size_t Count>
std::optional<std::array<std::int64_t, Count>> numbers(SqliteReader& reader, const std::string& sql) {
  Result<SqliteQuery, SqlError> query = reader.prepare(sql);
  if (!query) return std::nullopt;
  const Result<bool, SqlError> row = query->step();
  if (!row || !*row) return std::nullopt;
  std::array<std::int64_t, Count> values{};
  for (std::size_t i = 0; i < Count; ++i) {
    const auto value = query->integer(static_cast<int>(i));
    if (!value) return std::nullopt;
    values[i] = *value;
  }
  return values;
}

/// Parses "west,south,east,north"; anything else gives the whole planet.
GeoRect bounds_of(std::string_view text) {
  std::array<double, 4> side{};
  for (double& value : side) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const auto number = read_number(text.substr(0, comma));
    if (!number) return {};
    value = *number;
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  const bool area = text.empty() && side[0] < side[2] && side[1] < side[3];
  if (!area) return {};
  return {.west = Angle::degrees(std::clamp(side[0], -180.0, 180.0)),
          .south = Angle::degrees(std::clamp(side[1], -90.0, 90.0)),
          .east = Angle::degrees(std::clamp(side[2], -180.0, 180.0)),
          .north = Angle::degrees(std::clamp(side[3], -90.0, 90.0))};
}

struct TileRange {
  std::int64_t first_column, last_column, first_row, last_row;
};

/// True if the tiles with this span cover the bounds: all columns, and only rows of the bounds, counted from the
/// south-west.
bool lie_over(const TileRange& tiles, const GeoRect& bounds, double span) {
  constexpr double kSliver = 1e-6;  // fraction of a tile
  const auto first = [&](double offset_deg) { return std::llround(std::floor(offset_deg / span + kSliver)); };
  const auto last = [&](double offset_deg) { return std::llround(std::ceil(offset_deg / span - kSliver)) - 1; };
  return tiles.first_column == first(bounds.west.deg() + 180.0) &&
         tiles.last_column == last(bounds.east.deg() + 180.0) && tiles.first_row >= first(bounds.south.deg() + 90.0) &&
         tiles.last_row <= last(bounds.north.deg() + 90.0);
}

/// Columns and rows under 0 are on no grid; such tiles are strays and left out.
std::optional<TileRange> tiles_of_level(SqliteReader& reader, int level) {
  const auto found = numbers<4>(reader, fmt::format("SELECT min(tile_column), max(tile_column), min(tile_row), "
                                                    "max(tile_row) FROM tiles WHERE zoom_level = {} AND "
                                                    "tile_column >= 0 AND tile_row >= 0",
                                                    level));
  if (!found) return std::nullopt;
  return TileRange{(*found)[0], (*found)[1], (*found)[2], (*found)[3]};
}

/// Says that tiles of a level are strays; empty if none are.
std::string strays_text(SqliteReader& reader, int level, const std::string& where) {
  const auto least =
      numbers<2>(reader, fmt::format("SELECT min(tile_column), min(tile_row) FROM tiles WHERE zoom_level = {}", level));
  if (!least || ((*least)[0] >= 0 && (*least)[1] >= 0)) return {};
  return fmt::format(
      "{}: its tiles with a column or row under 0 (level {}, column {}, row {} at the least) lie on no "
      "grid and are left out",
      where, level, (*least)[0], (*least)[1]);
}

/// 180°, or 360° if the finest tiles belong to one root tile.
double root_span_of(const std::optional<TileRange>& finest, const TileGrid& grid) {
  if (!finest || grid.max_level == 0) return 180.0;
  const double span = std::ldexp(180.0, -grid.max_level);
  return !lie_over(*finest, grid.bounds, span) && lie_over(*finest, grid.bounds, 2.0 * span) ? 360.0 : 180.0;
}

constexpr const char* kCutThePicture =
    "Cut the picture that it was made from instead: `gdalwarp -t_srs EPSG:4326 PICTURE new.tif -tr 0.1 0.1 -tap` if "
    "that is not in "
    "EPSG:4326, then ‹cut› new.tif";

/// Refuses tiles beyond the last column or row of the planet. They belong to another grid, or are counted in
/// another way.
Status check_tiles_lie_on(const std::optional<TileRange>& finest, const TileGrid& grid, const std::string& where) {
  if (!finest) return Done{};
  const std::int64_t width = columns(grid, grid.max_level);
  const std::int64_t height = rows(grid, grid.max_level);
  const bool inside =
      finest->first_column >= 0 && finest->last_column < width && finest->first_row >= 0 && finest->last_row < height;
  if (inside) return Done{};
  return Error{
      fmt::format("{}: it is in a grid of its own: level {} has columns {} to {} and rows {} to {}, a geodetic one at "
                  "most {} and {}. {}",
                  where, grid.max_level, finest->first_column, finest->last_column, finest->first_row, finest->last_row,
                  width, height, kCutThePicture)};
}

/// Leaves out the only tile of level 0, which reaches from -90° to 270° and lies on no grid that begins at 90°.
Status leave_out_root(TileGrid& grid, const std::string& where) {
  if (grid.root_span_deg < 360.0 || grid.min_level > 0) return Done{};
  if (grid.max_level == 0) return Error{where + ": its only level has one tile that reaches from -90° to 270°"};
  grid.min_level = 1;
  return Done{};
}

/// Error if the metadata name a reference system that is neither geodetic nor Web Mercator.
std::optional<Error> other_system(const Metadata& metadata, const std::string& where) {
  for (const char* name : {"crs", "srs"}) {
    const std::string crs = value_of(metadata, name);
    if (crs.empty() || is_web_mercator(crs)) continue;
    return Error{
        fmt::format("{}: its {} is {}; only longitude and latitude (EPSG:4326, CRS84) and Web Mercator "
                    "(EPSG:3857) can be drawn. {}",
                    where, name, crs.substr(0, 100), kCutThePicture)};
  }
  return std::nullopt;
}

/// Refuses a geodetic file without matching metadata. Such a file has columns that Web Mercator has not, or its tiles,
/// counted from the south, end at the equator.
Status check_mercator_tiles(const std::optional<TileRange>& finest, const TileGrid& grid, const std::string& where) {
  if (!finest) return Done{};
  const std::int64_t side = columns(grid, grid.max_level);
  const bool outside =
      finest->first_column < 0 || finest->last_column >= side || finest->first_row < 0 || finest->last_row >= side;
  const bool both_halves = grid.bounds.south.deg() < -10.0 && grid.bounds.north.deg() > 10.0;
  const bool south_alone = both_halves && grid.max_level > 0 && finest->last_row < side / 2;
  if (!outside && !south_alone) return Done{};
  return Error{fmt::format(
      "{}: it does not say that it is geodetic, so it should be in Web Mercator, but level {} has columns {} to {} and "
      "rows {} to {} of {}, which does not go with its bounds. If it is in EPSG:4326, say ‹projection› "
      "equirectangular, "
      "or write it into its metadata: INSERT INTO metadata VALUES ('profile', 'geodetic')",
      where, grid.max_level, finest->first_column, finest->last_column, finest->first_row, finest->last_row, side)};
}

Status place_mercator(const std::optional<TileRange>& finest, TileGrid& grid, const std::string& where) {
  grid.projection = Projection::web_mercator;
  grid.root_span_deg = 360.0;
  if (Status checked = check_grid(grid, where); !checked) return checked;
  return check_mercator_tiles(finest, grid, where);
}

Status place_geodetic(const std::optional<TileRange>& finest, TileGrid& grid, const std::string& where) {
  grid.root_span_deg = root_span_of(finest, grid);
  if (Status left = leave_out_root(grid, where); !left) return left;
  if (Status checked = check_grid(grid, where); !checked) return checked;
  return check_tiles_lie_on(finest, grid, where);
}

/// Reads the size and format of the tiles from one of them.
Status look_at_tile(SqliteReader& reader, TileSetInfo& info, const std::string& where) {
  Result<SqliteQuery, SqlError> query =
      reader.prepare("SELECT tile_data FROM tiles WHERE length(tile_data) > 0 LIMIT 1");
  if (!query) return Error{fmt::format("{}: the table \"tiles\": {}", where, query.error().message)};
  const Result<bool, SqlError> row = query->step();
  if (!row) return Error{fmt::format("{}: the table \"tiles\": {}", where, row.error().message)};
  const auto blob = *row ? query->blob(0) : std::nullopt;
  if (!blob) return Error{where + ": an MBTiles file that holds no tiles"};
  info.format = sniff_format(*blob);
  if (info.format == ImageFormat::unknown) {
    return Error{where + ": its tiles are not JPEG, PNG or WebP pictures (vector tiles are not read)"};
  }
  const Result<Image> tile = decode_image(*blob);
  if (!tile) return Error{fmt::format("{}: its first tile: {}", where, tile.error().message)};
  if (tile->width_px != tile->height_px) return Error{where + ": its tiles are not square"};
  info.grid.tile_px = tile->width_px;
  return Done{};
}

Status read_levels(SqliteReader& reader, const Metadata& metadata, TileGrid& grid, const std::string& where) {
  auto zooms = numbers<2>(reader, "SELECT min(zoom_level), max(zoom_level) FROM tiles");
  const auto least = read_number(value_of(metadata, "minzoom"));
  const auto most = read_number(value_of(metadata, "maxzoom"));
  const auto is_level = [](double zoom) { return zoom >= 0 && zoom <= kMaxTileLevel; };
  if (!zooms && least && most && is_level(*least) && is_level(*most)) {
    zooms = {static_cast<std::int64_t>(*least), static_cast<std::int64_t>(*most)};
  }
  if (!zooms) return Error{where + ": its zoom levels cannot be found out"};
  if ((*zooms)[0] < 0 || (*zooms)[1] > kMaxTileLevel || (*zooms)[0] > (*zooms)[1]) {
    return Error{fmt::format("{}: its zoom levels are {} to {}, [0, {}] can be read", where, (*zooms)[0], (*zooms)[1],
                             kMaxTileLevel)};
  }
  grid.min_level = static_cast<int>((*zooms)[0]);
  grid.max_level = static_cast<int>((*zooms)[1]);
  return Done{};
}

}  // namespace

Result<std::unique_ptr<TileSource>> open_mbtiles(const std::filesystem::path& path, bool geodetic) {
  const std::string where = path.string();
  const auto broken = [&](const SqlError& error) {
    return Error{fmt::format("{}: cannot be read as MBTiles: {}", where, error.message)};
  };
  Result<SqliteReader, SqlError> reader = SqliteReader::open(path, kMaxTileBytes);
  if (!reader) return broken(reader.error());
  const Result<Metadata, SqlError> metadata = read_metadata(*reader);
  if (!metadata) return broken(metadata.error());
  geodetic = geodetic || says_geodetic(*metadata);
  if (const auto other = other_system(*metadata, where); other && !geodetic) return *other;
  TileSetInfo info;
  info.name = value_of(*metadata, "name");
  info.attribution = value_of(*metadata, "attribution");
  info.body = stated_body(value_of(*metadata, "body"));
  info.grid.bounds = bounds_of(value_of(*metadata, "bounds"));
  if (Status looked = look_at_tile(*reader, info, where); !looked) return looked.error();
  if (Status levels = read_levels(*reader, *metadata, info.grid, where); !levels) return levels.error();
  const std::optional<TileRange> finest = tiles_of_level(*reader, info.grid.max_level);
  if (std::string strays = strays_text(*reader, info.grid.max_level, where); !strays.empty()) {
    info.remarks.push_back(std::move(strays));
  }
  const auto place = geodetic ? place_geodetic : place_mercator;
  if (Status placed = place(finest, info.grid, where); !placed) return placed.error();
  Result<std::unique_ptr<SqliteTiles>, SqlError> tiles = SqliteTiles::open(path, "tiles");
  if (!tiles) return broken(tiles.error());
  return std::unique_ptr<TileSource>(std::make_unique<MbtilesSource>(path, std::move(info), *std::move(tiles)));
}

}  // namespace terrella
