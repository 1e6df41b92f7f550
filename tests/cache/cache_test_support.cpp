#include "cache/cache_test_support.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <random>

namespace terrella::test {

namespace fs = std::filesystem;

TileSetInfo planet() {
  TileSetInfo info;
  info.name = "Planet";
  info.attribution = "Nobody";
  info.grid.max_level = 12;
  return info;
}

std::vector<std::byte> tile_bytes(const TileId& id, std::size_t size, unsigned version) {
  std::mt19937 random(static_cast<unsigned>(TileIdHash{}(id)) * 31 + version);
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i % 8 == 0 ? random() : i);
  return bytes;
}

CacheRecord tile_record(const TileId& id, std::size_t size, unsigned version) {
  return {.missing = {},
          .bytes = tile_bytes(id, size, version),
          .why = "",
          .etag = "\"" + std::to_string(version) + "\"",
          .last_modified = "Sun, 06 Nov 1994 08:49:37 GMT",
          .stored_unix_s = 1000 + version,
          .expires_unix_s = 2000 + version};
}

CacheRecord missing_record(MissingKind kind, const std::string& why, std::int64_t stored_unix_s) {
  CacheRecord record;
  record.missing = kind;
  record.why = why;
  record.stored_unix_s = stored_unix_s;
  record.expires_unix_s = stored_unix_s + 60;
  return record;
}

TileId nth_tile(int level, std::int64_t n) {
  const std::int64_t width = columns(planet().grid, level);
  return {level, n % width, n / width};
}

std::shared_ptr<TileCache> open_cache(const fs::path& path, const CacheOptions& options) {
  auto cache = TileCache::open(path, planet(), kSource, options);
  EXPECT_TRUE(cache) << cache.error().message;
  return cache ? *std::move(cache) : nullptr;
}

std::optional<CacheRecord> found(TileCache& cache, const TileId& id) {
  auto record = cache.find(id);
  EXPECT_TRUE(record) << record.error().message;
  return record ? *std::move(record) : std::nullopt;
}

std::string sql(const fs::path& path, const std::string& statement) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr), SQLITE_OK)
      << path;
  sqlite3_busy_timeout(database, 5000);
  std::string first;
  const auto take = [](void* text, int, char** values, char**) {
    auto& kept = *static_cast<std::string*>(text);
    if (kept.empty() && values[0] != nullptr) kept = values[0];
    return 0;
  };
  char* message = nullptr;
  sqlite3_exec(database, statement.c_str(), take, &first, &message);
  EXPECT_EQ(message, nullptr) << message << "\n" << statement;
  sqlite3_free(message);
  sqlite3_close(database);
  return first;
}

std::string integrity(const fs::path& path) { return sql(path, "PRAGMA integrity_check"); }

std::uintmax_t size_on_disk(const fs::path& path) {
  std::uintmax_t size = 0;
  for (const char* ending : {"", "-wal"}) {
    std::error_code error;
    const std::uintmax_t part = fs::file_size(path.string() + ending, error);
    if (!error) size += part;
  }
  return size;
}

}  // namespace terrella::test
