#include "streaming/convert/merge_into.h"

#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "streaming/cache/cache_part.h"
#include "streaming/convert/convert.h"
#include "streaming/convert/part_file.h"
#include "streaming/sets/directory_source.h"
#include "streaming/sqlite_reader.h"
#include "streaming/tile_lister.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostOpenCaches = 256;

// clang-format off
constexpr const char* kListSql =
    "SELECT zoom_level, tile_column, tile_row, t.id, s.stored FROM tiles t LEFT JOIN terrella_cache_tiles s ON s.id = t.id";
constexpr const char* kPlacesSchema[] = {
    "CREATE TABLE places (level INTEGER, x INTEGER, y INTEGER, cache INTEGER, row INTEGER, stored INTEGER, "
    "PRIMARY KEY (level, x, y)) WITHOUT ROWID",
    "BEGIN"};
constexpr const char* kAddSql =
    "INSERT INTO places VALUES (?1, ?2, ?3, ?4, ?5, ?6) ON CONFLICT DO UPDATE SET cache = ?4, row = ?5, stored = ?6 "
    "WHERE ?6 >= stored";
// clang-format on

/// The tiles of several caches. The one stored last counts if several have a place, in the last cache of the same time.
/// thread: one at a time
class MergedCaches : public TileSource, public TileLister {
 public:
  MergedCaches(const std::vector<fs::path>& caches, TileSetInfo info, const fs::path& output)
      : caches_(caches), info_(std::move(info)), output_(output), part_(cache_part_name(output)) {
    remove_dead_parts(output);
  }
  ~MergedCaches() override {
    find_.reset();
    places_.reset();
    remove_database(part_);
  }
  MergedCaches(const MergedCaches&) = delete;
  MergedCaches& operator=(const MergedCaches&) = delete;

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }

  [[nodiscard]] Status for_each_tile(const std::function<bool(const TileId&)>& call) override {
    auto add = make_places();
    if (!add) return cannot_write(output_, add.error());
    for (std::size_t cache = 0; cache < caches_.size(); ++cache) {
      auto tiles = query(cache, kListSql);
      if (!tiles) return Error{tiles.error().why};
      auto more = tiles->query.step();
      for (; more && *more; more = tiles->query.step()) {
        const auto number = [&](int column) { return tiles->query.integer(column).value_or(0); };
        const TileId id{.level = static_cast<int>(number(0)), .x = number(1), .y = number(2)};
        int index = 0;
        for (const std::int64_t value :
             {number(0), id.x, id.y, static_cast<std::int64_t>(cache), number(3), number(4)}) {
          add->bind(++index, value);
        }
        if (WriteStatus added = add->run(); !added) return cannot_write(output_, added.error());
        if (!call(id)) return Done{};
      }
      if (!more) return Error{unreadable(cache, more.error()).why};
    }
    return Done{};
  }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    find_->bind(1, static_cast<std::int64_t>(id.level));
    find_->bind(2, id.x);
    find_->bind(3, id.y);
    const auto found = find_->step();
    if (!found) return TileFailure{MissingKind::failed, found.error().message};
    if (!*found) return TileFailure{MissingKind::absent, "the caches do not have the tile"};
    const auto cache = static_cast<std::size_t>(find_->integer(0));
    const std::int64_t row = find_->integer(1);
    find_->reset();
    if (!open_.contains(cache)) {
      if (open_.size() == kMostOpenCaches) open_.clear();
      auto opened = query(cache, "SELECT tile_data FROM tiles WHERE id = ?1");
      if (!opened) return opened.error();
      open_.emplace(cache, *std::move(opened));
    }
    SqliteQuery& tile = open_.at(cache).query;
    tile.bind(1, row);
    const auto there = tile.step();
    if (!there) return unreadable(cache, there.error());
    if (!*there) {
      tile.reset();
      return TileFailure{MissingKind::failed,
                         caches_[cache].string() + ": another program has removed a tile; try again"};
    }
    const auto bytes = tile.blob(0);
    EncodedTile answer;
    if (bytes) answer.bytes.assign(bytes->begin(), bytes->end());
    tile.reset();
    if (answer.bytes.empty()) return TileFailure{MissingKind::blank, "the tile is empty"};
    return answer;
  }

 private:
  struct OpenQuery {
    SqliteReader reader;
    SqliteQuery query;
  };

  /// Makes the list of places. Returns the statement that adds one.
  WriteResult<SqliteStatement> make_places() {
    auto places = SqliteWriter::make_private(part_);
    if (!places) return places.error();
    places_ = *std::move(places);
    for (const char* sql : kPlacesSchema) {
      if (WriteStatus done = places_->run(sql); !done) return done.error();
    }
    auto find = places_->prepare("SELECT cache, row FROM places WHERE level = ?1 AND x = ?2 AND y = ?3");
    if (!find) return find.error();
    find_ = *std::move(find);
    return places_->prepare(kAddSql);
  }

  [[nodiscard]] TileFailure unreadable(std::size_t cache, const SqlError& error) const {
    return {MissingKind::failed, caches_[cache].string() + ": the cache cannot be read: " + error.message};
  }

  [[nodiscard]] Result<OpenQuery, TileFailure> query(std::size_t cache, const char* sql) const {
    auto reader = SqliteReader::open(caches_[cache], kMaxTileBytes);
    if (!reader) return unreadable(cache, reader.error());
    // One transaction for all tiles: each one of its own would lock and look for journals.
    auto begin = reader->prepare("BEGIN");
    if (auto begun = begin ? begin->step() : begin.error(); !begun) return unreadable(cache, begun.error());
    auto prepared = reader->prepare(sql);
    if (!prepared) return unreadable(cache, prepared.error());
    return OpenQuery{*std::move(reader), *std::move(prepared)};
  }

  const std::vector<fs::path> caches_;
  const TileSetInfo info_;
  const fs::path output_, part_;
  std::optional<SqliteWriter> places_;
  std::optional<SqliteStatement> find_;
  std::map<std::size_t, OpenQuery> open_;
};

}  // namespace

std::shared_ptr<TileSource> merged_tiles(const std::vector<fs::path>& caches, TileSetInfo info,
                                         const fs::path& output) {
  return std::make_shared<MergedCaches>(caches, std::move(info), output);
}

Result<MergeSummary> merge_into(const std::vector<fs::path>& caches, const fs::path& output,
                                const MergeProgress& progress) {
  const auto together = report_together(caches);
  if (!together) return together.error();
  const auto merged = convert({.from = caches.front(),
                               .to = output,
                               .source = merged_tiles(caches, together->info, output),
                               .mark = "merged",
                               .progress = progress});
  if (!merged) return merged.error();
  return MergeSummary{.tiles = merged->tiles, .dropped = together->tiles - merged->tiles};
}

}  // namespace terrella
