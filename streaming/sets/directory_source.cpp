#include "streaming/sets/directory_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/number.h"
#include "streaming/file_bytes.h"
#include "streaming/sets/tileset_json.h"
#include "streaming/sets/tms_xml.h"
#include "streaming/tile_lister.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

struct Range {
  std::int64_t first, last;
  bool operator==(const Range&) const = default;
  [[nodiscard]] bool within(const Range& other) const { return first >= other.first && last <= other.last; }
};

void widen(std::optional<Range>& range, std::int64_t value) {
  range = range ? Range{std::min(range->first, value), std::max(range->last, value)} : Range{value, value};
}

/// Smallest and largest number among the names in a folder, without endings.
std::optional<Range> numbers_in(const fs::path& folder) {
  std::optional<Range> range;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().stem().string();
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc{} && end == name.data() + name.size()) widen(range, number);
  }
  return range;
}

/// Tiles of a span that cover [low, high] degrees, counted from `origin`.
Range tiles_over(double low_deg, double high_deg, double origin_deg, double span_deg) {
  constexpr double kSliver = 1e-6;  // fraction of a tile
  return {static_cast<std::int64_t>(std::floor((low_deg - origin_deg) / span_deg + kSliver)),
          static_cast<std::int64_t>(std::ceil((high_deg - origin_deg) / span_deg - kSliver)) - 1};
}

/// Detects the number of root tiles of a set by gdal2tiles.py --profile=geodetic. That program makes sets with two root
/// tiles (--tmscompatible) or one, and describes both as having two. This function looks at the columns and rows of the
/// finest level in `root`. If they belong to one root tile, it doubles the root span of `tms` and leaves out level 0,
/// whose tile begins at -90° and ends at 270°.
Result<TmsDescription> correct_tms_roots(TmsDescription tms, const fs::path& root) {
  const TileGrid& grid = tms.info.grid;
  if (grid.projection != Projection::equirectangular) return tms;
  const fs::path finest = root / tms.folder.at(grid.max_level);
  const std::optional<Range> columns = numbers_in(finest);
  if (!columns) return tms;
  const std::optional<Range> rows = numbers_in(finest / std::to_string(columns->last));
  if (!rows) return tms;
  const auto fits = [&](double span_deg) {
    return *columns == tiles_over(grid.bounds.west.deg(), grid.bounds.east.deg(), -180.0, span_deg) &&
           rows->within(tiles_over(grid.bounds.south.deg(), grid.bounds.north.deg(), -90.0, span_deg));
  };
  const double span_deg = tile_span_deg(grid, grid.max_level);
  if (fits(span_deg) || !fits(2.0 * span_deg)) return tms;
  tms.info.grid.root_span_deg *= 2.0;
  if (180.0 / tile_span_deg(tms.info.grid, grid.min_level) < 0.75) {
    if (grid.min_level == grid.max_level) {
      return Error{
          root.string() +
          ": its only level has one tile that reaches from -90° to 270°; make more levels (gdal2tiles.py -z 1-…)"};
    }
    tms.folder.erase(grid.min_level);
    ++tms.info.grid.min_level;
  }
  return tms;
}

namespace fs = std::filesystem;

/// Rows of the set's tiles at a level.
std::int64_t rows_of(const TileSetInfo& info, int level) {
  const bool own = info.square && !info.square->levels.empty();
  return own ? info.square->levels.at(static_cast<std::size_t>(level)).rows : rows(info.grid, level);
}

/// Numbers of columns and rows are smaller than this at every level.
constexpr double kMostTilesAcross = 1e15;

/// Parses a name as a whole number, written like tile names; nothing for other names.
std::optional<std::int64_t> number_named(const std::string& name) {
  const auto number = read_number(name);
  if (!number || *number != std::floor(*number) || std::abs(*number) > kMostTilesAcross) return {};
  const auto whole = static_cast<std::int64_t>(*number);
  return std::to_string(whole) == name ? std::optional(whole) : std::nullopt;
}

class DirectorySource : public TileSource, public TileLister {
 public:
  DirectorySource(TileSetInfo info, DirectoryLayout layout) : info_(std::move(info)), layout_(std::move(layout)) {}

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the tile set"};
    const fs::path path = path_of(id);
    Result<std::vector<std::byte>, FileError> bytes = read_file(path, kMaxTileBytes);
    if (!bytes) return failure(bytes.error());
    if (bytes->empty()) return TileFailure{MissingKind::blank, path.string() + ": an empty file"};
    return EncodedTile{*std::move(bytes)};
  }

  [[nodiscard]] std::optional<std::int64_t> count_tiles(int level) override {
    const auto folder = layout_.folder.find(level);
    if (folder == layout_.folder.end()) return 0;
    std::int64_t count = 0;
    std::error_code error;
    for (const fs::directory_entry& column : fs::directory_iterator(layout_.root / folder->second, error)) {
      std::error_code not_a_folder;
      for (const fs::directory_entry& tile : fs::directory_iterator(column.path(), not_a_folder)) {
        if (tile.path().extension() == "." + layout_.extension) ++count;
      }
    }
    return count;
  }

  [[nodiscard]] Status for_each_tile(const std::function<bool(const TileId&)>& call) override {
    for (const auto& [level, folder] : layout_.folder) {
      for (const bool squeezed : {false, true}) {
        if (squeezed && !info_.grid.reduced) continue;
        const Result<bool> more = list_level(level, squeezed, call);
        if (!more) return more.error();
        if (!*more) return Done{};
      }
    }
    return Done{};
  }

 private:
  using Call = std::function<bool(const TileId&)>;

  [[nodiscard]] fs::path levels(bool squeezed) const {
    return squeezed ? layout_.root / kSqueezedFolder : layout_.root;
  }

  /// Lists a level. Returns false if `call` wants no more. A level without a folder has no tiles.
  [[nodiscard]] Result<bool> list_level(int level, bool squeezed, const Call& call) const {
    const fs::path folder = levels(squeezed) / layout_.folder.at(level);
    std::error_code failed;
    for (fs::directory_iterator column(folder, failed), end; !failed && column != end; column.increment(failed)) {
      const auto x = number_named(column->path().filename().string());
      std::error_code vanished;
      if (!x || !column->is_directory(vanished)) continue;
      const Result<bool> more = list_column(column->path(), {.level = level, .x = *x}, squeezed, call);
      if (!more || !*more) return more;
    }
    if (failed && failed != std::errc::no_such_file_or_directory) return cannot_list(folder, failed);
    return true;
  }

  [[nodiscard]] Result<bool> list_column(const fs::path& folder, TileId id, bool squeezed, const Call& call) const {
    std::error_code failed;
    for (fs::directory_iterator tile(folder, failed), end; !failed && tile != end; tile.increment(failed)) {
      const auto row = number_named(tile->path().stem().string());
      if (!row || tile->path().extension() != "." + layout_.extension) continue;
      id.y = layout_.rows_from_south ? rows_of(info_, id.level) - 1 - *row : *row;
      id.squeeze =
          squeezed && id.y >= 0 && id.y < rows(info_.grid, id.level) ? squeeze_of_row(info_.grid, id.level, id.y) : 0;
      if ((id.squeeze > 0) != squeezed || !exists(info_.grid, id)) continue;
      if (!call(id)) return false;
    }
    if (failed) return cannot_list(folder, failed);
    return true;
  }

  static Error cannot_list(const fs::path& folder, const std::error_code& why) {
    return Error{fmt::format("{}: cannot be listed: {}; check the folder's rights", folder.string(), why.message())};
  }

  [[nodiscard]] fs::path path_of(const TileId& id) const {
    const std::int64_t row = layout_.rows_from_south ? rows_of(info_, id.level) - 1 - id.y : id.y;
    // One text: joining paths part by part takes longer than to read a tile that the system has in memory.
    return fmt::format("{}/{}{}/{}/{}.{}", layout_.root.native(), id.squeeze != 0 ? squeezed_ : "",
                       layout_.folder.at(id.level), id.x, row, layout_.extension);
  }

  static TileFailure failure(const FileError& error) {
    switch (error.problem) {
      case FileProblem::missing:
        return {MissingKind::absent, error.message};
      case FileProblem::too_large:
        return {MissingKind::broken, error.message};
      case FileProblem::unreadable:
        break;
    }
    return {MissingKind::failed, error.message};
  }

  const TileSetInfo info_;
  const DirectoryLayout layout_;
  const std::string squeezed_ = std::string(kSqueezedFolder) + "/";
};

bool has_any_level(const DirectoryLayout& layout) {
  for (const auto& [level, folder] : layout.folder) {
    std::error_code ignored;
    if (fs::is_directory(layout.root / folder, ignored)) return true;
  }
  return false;
}

Result<std::unique_ptr<TileSource>> with_tiles(TileSetInfo info, DirectoryLayout layout, const fs::path& description) {
  if (!has_any_level(layout)) {
    return Error{fmt::format("{}: {} describes levels {} to {}, but there is no folder \"{}\" or any other with tiles",
                             layout.root.string(), description.filename().string(), info.grid.min_level,
                             info.grid.max_level, layout.folder.begin()->second)};
  }
  return make_directory_source(std::move(info), std::move(layout));
}

Result<std::unique_ptr<TileSource>> open_json(const fs::path& root, const fs::path& description) {
  const auto bytes = read_file(description, kMaxTileSetJsonBytes);
  if (!bytes) return Error{bytes.error().message};
  Result<TileSetInfo> info = parse_tileset_json(as_text(*bytes), description.string());
  if (!info) return info.error();
  DirectoryLayout layout{.root = root, .folder = {}, .extension = tile_ending(*info)};
  for (int level = info->grid.min_level; level <= info->grid.max_level; ++level) {
    layout.folder[level] = std::to_string(level);
  }
  return with_tiles(*std::move(info), std::move(layout), description);
}

Result<std::unique_ptr<TileSource>> open_tms(const fs::path& root, const fs::path& description) {
  const auto bytes = read_file(description, kMaxTmsXmlBytes);
  if (!bytes) return Error{bytes.error().message};
  Result<TmsDescription> tms = parse_tms_xml(as_text(*bytes), description.string());
  if (!tms) return tms.error();
  tms = correct_tms_roots(*std::move(tms), root);
  if (!tms) return tms.error();
  DirectoryLayout layout{
      .root = root, .folder = std::move(tms->folder), .extension = tms->extension, .rows_from_south = true};
  return with_tiles(std::move(tms->info), std::move(layout), description);
}

}  // namespace

std::unique_ptr<TileSource> make_directory_source(TileSetInfo info, DirectoryLayout layout) {
  return std::make_unique<DirectorySource>(std::move(info), std::move(layout));
}

Result<std::unique_ptr<TileSource>> open_directory(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(path / kTileSetFile, ignored)) return open_json(path, path / kTileSetFile);
  if (fs::exists(path / kTmsFile, ignored)) return open_tms(path, path / kTmsFile);
  const bool empty = fs::is_empty(path, ignored);
  return Error{fmt::format(
      "{}: {}, so it is not a tile set. A directory must hold tiles as {{z}}/{{x}}/{{y}}.jpg, .png or .webp and "
      "beside them {} (written "
      "by ‹cut›) or the {} of a geodetic TMS",
      path.string(),
      empty ? "the directory is empty" : "the directory holds no tileset.json and no tilemapresource.xml", kTileSetFile,
      kTmsFile)};
}

}  // namespace terrella
