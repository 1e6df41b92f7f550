#include "streaming/mosaic/mosaic_store.h"

#include <array>
#include <chrono>
#include <cstring>
#include <string_view>

namespace terrella {
namespace {

/// The folder of a cache is used by one user, so another process never holds the file for long.
constexpr std::chrono::milliseconds kPatience{2000};

constexpr std::array kSchema = {
    std::string_view("PRAGMA journal_mode=WAL"), std::string_view("PRAGMA wal_autocheckpoint=1000"),
    std::string_view("PRAGMA synchronous=NORMAL"),
    std::string_view(
        "CREATE TABLE IF NOT EXISTS header(path TEXT PRIMARY KEY, mark INTEGER NOT NULL, facts TEXT NOT NULL)"),
    std::string_view("CREATE TABLE IF NOT EXISTS tile(level INTEGER, x INTEGER, y INTEGER, mark INTEGER NOT NULL, "
                     "bytes BLOB NOT NULL, "
                     "PRIMARY KEY(level, x, y))")};

std::int64_t as_signed(std::uint64_t mark) { return static_cast<std::int64_t>(mark); }

}  // namespace

Result<std::unique_ptr<MosaicStore>> MosaicStore::open(const std::filesystem::path& path) {
  auto database = SqliteWriter::open(path, SqliteWriter::Mode::create);
  if (!database) return Error{path.string() + ": " + database.error().message};
  database->wait_for_locks(kPatience);
  for (const std::string_view sql : kSchema) {
    const auto done = database->run(sql);
    if (!done) return Error{path.string() + ": " + done.error().message};
  }
  return std::unique_ptr<MosaicStore>(new MosaicStore(*std::move(database)));
}

MosaicStore::Headers MosaicStore::headers() {
  const std::lock_guard lock(mutex_);
  Headers headers;
  auto rows = database_.prepare("SELECT path, mark, facts FROM header");
  if (!rows) return headers;
  for (auto more = rows->step(); more && *more; more = rows->step()) {
    headers.emplace(rows->text(0), std::pair(static_cast<std::uint64_t>(rows->integer(1)), rows->text(2)));
  }
  return headers;
}

void MosaicStore::keep_headers(const std::vector<Header>& headers) {
  const std::lock_guard lock(mutex_);
  auto insert = database_.prepare("INSERT OR REPLACE INTO header(path, mark, facts) VALUES(?1, ?2, ?3)");
  if (!insert || !database_.run("BEGIN IMMEDIATE")) return;
  for (const Header& header : headers) {
    insert->bind(1, std::string_view(header.path));
    insert->bind(2, as_signed(header.mark));
    insert->bind(3, std::string_view(header.text));
    if (!insert->run()) break;
  }
  if (!database_.run("COMMIT")) static_cast<void>(database_.run("ROLLBACK"));
}

std::optional<std::vector<std::byte>> MosaicStore::tile(const TileId& id, std::uint64_t mark) {
  const std::lock_guard lock(mutex_);
  auto row = database_.prepare("SELECT bytes FROM tile WHERE level = ?1 AND x = ?2 AND y = ?3 AND mark = ?4");
  if (!row) return {};
  row->bind(1, std::int64_t{id.level});
  row->bind(2, id.x);
  row->bind(3, id.y);
  row->bind(4, as_signed(mark));
  const auto found = row->step();
  if (!found || !*found) return {};
  const std::string text = row->text(0);
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

void MosaicStore::keep_tile(const TileId& id, std::uint64_t mark, const std::vector<std::byte>& bytes) {
  const std::lock_guard lock(mutex_);
  auto insert = database_.prepare("INSERT OR REPLACE INTO tile(level, x, y, mark, bytes) VALUES(?1, ?2, ?3, ?4, ?5)");
  if (!insert) return;
  insert->bind(1, std::int64_t{id.level});
  insert->bind(2, id.x);
  insert->bind(3, id.y);
  insert->bind(4, as_signed(mark));
  insert->bind(5, std::span<const std::byte>(bytes));
  static_cast<void>(insert->run());
}

}  // namespace terrella
