#include "streaming/convert/tile_order.h"

#include <utility>

#include "streaming/convert/web_tiles.h"
#include "streaming/pmtiles/tile_number.h"

namespace terrella {

TileOrder::TileOrder(SqliteWriter database, SqliteStatement insert, const TileGrid& grid)
    : database_(std::move(database)), insert_(std::move(insert)) {
  if (grid.projection != Projection::web_mercator) return;
  zoom_of_roots_ = zoom_of_roots(grid);
  by_curve_ = zoom_of_roots_ + grid.max_level <= kMaxTileLevel;
}

WriteResult<TileOrder> TileOrder::make(const std::filesystem::path& path, const TileGrid& grid) {
  auto database = SqliteWriter::make_private(path);
  if (!database) return database.error();
  for (const char* sql : {"CREATE TABLE places (level INTEGER, squeeze INTEGER, number INTEGER, y INTEGER, x INTEGER, "
                          "PRIMARY KEY (level, squeeze, number, y, x)) WITHOUT ROWID",
                          "BEGIN"}) {
    if (WriteStatus done = database->run(sql); !done) return done.error();
  }
  auto insert = database->prepare("INSERT OR IGNORE INTO places VALUES (?1, ?2, ?3, ?4, ?5)");
  if (!insert) return insert.error();
  return TileOrder(*std::move(database), *std::move(insert), grid);
}

WriteStatus TileOrder::add(const TileId& id) {
  const TileId web{.level = id.level + zoom_of_roots_, .x = id.x, .y = id.y};
  insert_.bind(1, static_cast<std::int64_t>(id.level));
  insert_.bind(2, static_cast<std::int64_t>(id.squeeze));
  insert_.bind(3, by_curve_ ? static_cast<std::int64_t>(tile_number(web)) : 0);
  insert_.bind(4, id.y);
  insert_.bind(5, id.x);
  if (WriteStatus inserted = insert_.run(); !inserted) return inserted;
  count_ += database_.changed_rows();
  return Done{};
}

WriteStatus TileOrder::for_each(const std::function<bool(const TileId& id)>& call) {
  auto query = database_.prepare("SELECT level, squeeze, y, x FROM places ORDER BY level, squeeze, number, y, x");
  if (!query) return query.error();
  for (;;) {
    const WriteResult<bool> more = query->step();
    if (!more) return more.error();
    if (!*more) return Done{};
    const TileId id{.level = static_cast<int>(query->integer(0)),
                    .x = query->integer(3),
                    .y = query->integer(2),
                    .squeeze = static_cast<int>(query->integer(1))};
    if (!call(id)) return Done{};
  }
}

}  // namespace terrella
