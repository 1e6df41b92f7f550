#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cerrno>

#include "streaming/cut/output/part_name.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/sets/gpkg_schema.h"
#include "streaming/sets/tileset_json.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct FinalizeStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;
using Statement = std::unique_ptr<sqlite3_stmt, FinalizeStatement>;

class GpkgWriter : public TileWriter {
 public:
  explicit GpkgWriter(const WriterSetup& setup)
      : output_(setup.output), part_(setup.part.string() + ".gpkg"), may_replace_(setup.may_replace) {}
  ~GpkgWriter() override {
    insert_.reset();
    insert_squeezed_.reset();
    describe_.reset();
    database_.reset();
    std::error_code ignored;
    fs::remove(part_, ignored);
  }
  GpkgWriter(const GpkgWriter&) = delete;
  GpkgWriter& operator=(const GpkgWriter&) = delete;

  [[nodiscard]] Status open(const WriterSetup& setup) {
    // The name must be new, because SQLite would continue in an existing file.
    std::error_code ignored;
    fs::remove(part_, ignored);
    const int file = ::open(part_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) return cannot_write(output_, errno);
    close(file);
    sqlite3* database = nullptr;
    const int opened = sqlite3_open_v2(part_.c_str(), &database, SQLITE_OPEN_READWRITE, nullptr);
    database_.reset(database);
    if (opened != SQLITE_OK) return failure();
    // No rollback: no other process knows the file, and a broken one is deleted. finish() syncs it once before it gets
    // its name.
    for (const char* pragma : {"PRAGMA journal_mode = OFF", "PRAGMA synchronous = OFF",
                               "PRAGMA locking_mode = EXCLUSIVE", "PRAGMA page_size = 8192"}) {
      if (!run({pragma, {}})) return failure();
    }
    const auto schema = geopackage_schema(setup.info, setup.last_change, setup.mark);
    // The first two statements are pragmas that do not work inside a transaction.
    for (std::size_t i = 0; i < schema.size(); ++i) {
      if (i == 2 && !run({"BEGIN", {}})) return failure();
      if (!run(schema[i])) return failure();
    }
    const std::string values = " (zoom_level, tile_column, tile_row, tile_data) VALUES (?1, ?2, ?3, ?4)";
    insert_ = prepare("INSERT INTO tiles" + values);
    if (setup.info.grid.reduced) {
      insert_squeezed_ = prepare(std::string("INSERT INTO ") + kSqueezedTable + values);
      if (!insert_squeezed_) return failure();
    }
    if (insert_ && is_coverage(setup.info)) {
      describe_ = prepare("INSERT INTO gpkg_2d_gridded_tile_ancillary (tpudt_name, tpudt_id) VALUES ('tiles', ?1)");
      if (!describe_) return failure();
    }
    return insert_ ? Status(Done{}) : Status(failure());
  }

  [[nodiscard]] Status put(const TileId& id, std::span<const std::byte> bytes) override {
    sqlite3_stmt* insert = id.squeeze == 0 ? insert_.get() : insert_squeezed_.get();
    sqlite3_bind_int(insert, 1, id.level);
    sqlite3_bind_int64(insert, 2, id.x);
    sqlite3_bind_int64(insert, 3, id.y);
    sqlite3_bind_blob64(insert, 4, bytes.data(), bytes.size(), SQLITE_STATIC);
    if (step(insert) != SQLITE_DONE) return failure();
    sqlite3_reset(insert);
    if (!describe_) return Done{};
    sqlite3_bind_int64(describe_.get(), 1, sqlite3_last_insert_rowid(database_.get()));
    if (step(describe_.get()) != SQLITE_DONE) return failure();
    sqlite3_reset(describe_.get());
    return Done{};
  }

  [[nodiscard]] Status finish() override {
    insert_.reset();
    insert_squeezed_.reset();
    describe_.reset();
    if (!run({"COMMIT", {}})) return failure();
    database_.reset();
    if (Status synced = sync_to_disk(part_); !synced) return synced;
    return take_name(part_, output_, may_replace_);
  }

 private:
  Statement prepare(const std::string& sql) {
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr);
    return Statement(statement);
  }

  /// Calls sqlite3_step() and saves the system's errno, because sqlite3_system_errno() does not see failures in COMMIT.
  int step(sqlite3_stmt* statement) {
    errno = 0;
    const int stepped = sqlite3_step(statement);
    if (stepped != SQLITE_DONE && stepped != SQLITE_ROW) system_error_ = errno;
    return stepped;
  }

  bool run(const SqlStatement& said) {
    const Statement statement = prepare(said.sql);
    if (!statement) return false;
    int parameter = 0;
    for (const std::string& text : said.texts) {
      sqlite3_bind_text(statement.get(), ++parameter, text.data(), static_cast<int>(text.size()), SQLITE_STATIC);
    }
    for (const double number : said.numbers) sqlite3_bind_double(statement.get(), ++parameter, number);
    const int stepped = step(statement.get());
    return stepped == SQLITE_DONE || stepped == SQLITE_ROW;
  }

  /// Reason of the last failure: the system's if there is one, else SQLite's.
  [[nodiscard]] Error failure() const {
    if (!database_) return Error{fmt::format("{}: cannot be written: out of memory", output_.string())};
    if (sqlite3_errcode(database_.get()) == SQLITE_FULL) return cannot_write(output_, ENOSPC);
    if (system_error_ != 0) return cannot_write(output_, system_error_);
    return Error{fmt::format("{}: cannot be written: {}", output_.string(), sqlite3_errmsg(database_.get()))};
  }

  fs::path output_;
  fs::path part_;
  MayReplace may_replace_;
  Database database_;
  Statement insert_;
  Statement insert_squeezed_;  ///< null unless the grid is reduced
  Statement describe_;         ///< inserts the side row of a height tile; null for pictures
  int system_error_ = 0;       ///< errno of the last failed call
};

}  // namespace

Result<std::unique_ptr<TileWriter>> make_gpkg_writer(const WriterSetup& setup) {
  auto writer = std::make_unique<GpkgWriter>(setup);
  if (Status opened = writer->open(setup); !opened) return opened.error();
  return std::unique_ptr<TileWriter>(std::move(writer));
}

}  // namespace terrella
