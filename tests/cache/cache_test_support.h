#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "streaming/cache/tile_cache.h"
#include "tests/support/scratch_folder.h"

namespace terrella::test {

inline constexpr const char* kSource = "https://tiles.example/{z}/{x}/{y}.jpg";

/// A whole planet, levels 0 to 12, JPEG.
[[nodiscard]] TileSetInfo planet();

/// Bytes that belong to a tile and a version of it and to no other.
[[nodiscard]] std::vector<std::byte> tile_bytes(const TileId& id, std::size_t size, unsigned version = 0);
[[nodiscard]] CacheRecord tile_record(const TileId& id, std::size_t size = 3000, unsigned version = 0);
[[nodiscard]] CacheRecord missing_record(MissingKind kind, const std::string& why, std::int64_t stored_unix_s = 1000);

/// The n-th tile of a level, row by row from the north.
[[nodiscard]] TileId nth_tile(int level, std::int64_t n);

/// Opens a cache of planet(); fails the test if that fails.
[[nodiscard]] std::shared_ptr<TileCache> open_cache(const std::filesystem::path& path,
                                                    const CacheOptions& options = {});
/// Looks a tile up; fails the test on an error.
[[nodiscard]] std::optional<CacheRecord> found(TileCache& cache, const TileId& id);

/// The first column of the first row, by a connection of its own.
std::string sql(const std::filesystem::path& path, const std::string& statement);
/// PRAGMA integrity_check's words.
[[nodiscard]] std::string integrity(const std::filesystem::path& path);
/// Main file and write-ahead log.
[[nodiscard]] std::uintmax_t size_on_disk(const std::filesystem::path& path);

}  // namespace terrella::test
