#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "base/result.h"
#include "streaming/cache/tile_cache.h"

namespace terrella {

/// Bytes of a size that the user states in megabytes (10^6 bytes). thread: any
[[nodiscard]] constexpr std::uint64_t megabytes(std::size_t mb) { return std::uint64_t{mb} * 1'000'000; }

/// Opens a cache of at most `max_mb` megabytes (0: no limit), as TileCache::open() does. Reports a lock
/// that it waits for, and a damaged file that was set aside, on standard error; `who` begins these messages.
/// `on_failed`: see CacheOptions. thread: any
[[nodiscard]] Result<std::shared_ptr<TileCache>, CacheOpenError> open_cache(
    const std::string& who, const std::filesystem::path& file, const TileSetInfo& info, const std::string& source_key,
    std::size_t max_mb, std::function<void(const Error&)> on_failed);

/// Reports on standard error, once per run, why the program continues without a cache. thread: any
void say_without_cache(const Error& why);

/// True if a file can be created in the folder; creates the folder if needed. thread: any
[[nodiscard]] bool can_write_into(const std::filesystem::path& folder);

/// The cache beside another one that holds its source at another time: a.2026-06-21.gpkg beside a.gpkg. thread: any
[[nodiscard]] std::filesystem::path file_of_time(const std::filesystem::path& cache, const std::string& time);

}  // namespace terrella
