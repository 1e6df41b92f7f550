#include <fmt/format.h>

#include <optional>
#include <utility>

#include "streaming/convert/part_file.h"
#include "streaming/convert/web_tiles.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/sets/tileset_json.h"

namespace terrella {
namespace {

/// MBTiles 1.3 (github.com/mapbox/mbtiles-spec). The number is "MPBX".
constexpr const char* kMbtilesSchema[] = {
    "PRAGMA application_id = 1297105496",
    "BEGIN",
    "CREATE TABLE metadata (name TEXT, value TEXT)",
    "CREATE TABLE tiles (zoom_level INTEGER, tile_column INTEGER, tile_row INTEGER, tile_data BLOB)",
    "CREATE UNIQUE INDEX metadata_index ON metadata (name)",
    "CREATE UNIQUE INDEX tile_index ON tiles (zoom_level, tile_column, tile_row)"};

class MbtilesWriter : public TileWriter {
 public:
  explicit MbtilesWriter(const WriterSetup& setup)
      : setup_(setup), part_(setup.part.string() + ".mbtiles"), zoom_of_roots_(zoom_of_roots(setup.info.grid)) {}
  ~MbtilesWriter() override {
    insert_.reset();
    database_.reset();
    remove_database(part_);
  }
  MbtilesWriter(const MbtilesWriter&) = delete;
  MbtilesWriter& operator=(const MbtilesWriter&) = delete;

  [[nodiscard]] Status open() { return written(setup_.output, make()); }

  [[nodiscard]] Status put(const TileId& id, std::span<const std::byte> bytes) override {
    const int zoom = id.level + zoom_of_roots_;
    zooms_.add(zoom);
    insert_->bind(1, static_cast<std::int64_t>(zoom));
    insert_->bind(2, id.x);
    insert_->bind(3, (std::int64_t{1} << zoom) - 1 - id.y);
    insert_->bind(4, bytes);
    return written(setup_.output, insert_->run());
  }

  [[nodiscard]] Status finish() override {
    if (zooms_.empty()) return no_tiles_to_write(setup_.output);
    if (Status described = written(setup_.output, describe()); !described) return described;
    insert_.reset();
    if (Status done = written(setup_.output, database_->run("COMMIT")); !done) return done;
    database_.reset();
    if (Status synced = sync_to_disk(part_); !synced) return synced;
    return take_name(part_, setup_.output, setup_.may_replace);
  }

 private:
  WriteStatus make() {
    auto database = SqliteWriter::make_private(part_);
    if (!database) return database.error();
    database_ = *std::move(database);
    for (const char* sql : kMbtilesSchema) {
      if (WriteStatus done = database_->run(sql); !done) return done;
    }
    auto insert = database_->prepare("INSERT INTO tiles VALUES (?1, ?2, ?3, ?4)");
    if (!insert) return insert.error();
    insert_ = *std::move(insert);
    return Done{};
  }

  WriteStatus describe() {
    const TileSetInfo& info = setup_.info;
    const GeoRect bounds = web_bounds(info.grid);
    const double west = tidy_degrees(bounds.west), south = tidy_degrees(bounds.south);
    const double east = tidy_degrees(bounds.east), north = tidy_degrees(bounds.north);
    const std::pair<const char*, std::string> rows[] = {
        {"name", info.name.empty() ? setup_.output.stem().string() : info.name},
        {"format", extension_of(info.format)},
        {"bounds", fmt::format("{},{},{},{}", west, south, east, north)},
        {"center", fmt::format("{},{},{}", (west + east) / 2.0, (south + north) / 2.0, zooms_.least)},
        {"minzoom", std::to_string(zooms_.least)},
        {"maxzoom", std::to_string(zooms_.most)},
        {"attribution", info.attribution},
        {"body", info.body},
        {"type", layer_type(info.format)},
        {"scheme", "tms"},
        {kCutKeyField, setup_.mark},
    };
    for (const auto& [name, value] : rows) {
      if (value.empty()) continue;
      if (WriteStatus done = database_->run({"INSERT INTO metadata VALUES (?1, ?2)", {name, value}}); !done)
        return done;
    }
    return Done{};
  }

  const WriterSetup setup_;
  const std::filesystem::path part_;
  const int zoom_of_roots_;
  ZoomRange zooms_;
  std::optional<SqliteWriter> database_;
  std::optional<SqliteStatement> insert_;
};

}  // namespace

Result<std::unique_ptr<TileWriter>> make_mbtiles_writer(const WriterSetup& setup) {
  auto writer = std::make_unique<MbtilesWriter>(setup);
  if (Status opened = writer->open(); !opened) return opened.error();
  return std::unique_ptr<TileWriter>(std::move(writer));
}

}  // namespace terrella
