#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/url.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A file with the data of one time. The text of the time is of ISO 8601: "2026-06" is all of June.
struct DatedFile {
  std::string time;
  std::filesystem::path file;
};

/// Opens the file of one time. thread: any, one at a time
using OpenDatedFile = std::function<Result<std::shared_ptr<TileSource>>(const std::filesystem::path& file)>;

/// True for a path whose file name has {time} or {time:FORMAT}. thread: any
[[nodiscard]] bool names_dated_files(const Url& address);

/// Finds the files whose names fit a pattern; maybe none. {time} is a time as 2026-06-01, with hyphens for colons;
/// {time:FORMAT} has the codes %Y %y %m %b %B %d %j %H %M %S %s %% of strptime, in UTC. The error names the pattern.
/// thread: any
[[nodiscard]] Result<std::vector<DatedFile>> find_dated_files(const std::filesystem::path& pattern);

/// Opens files as one set, whose steps are their times. It starts at the last one at or before `time`, else at the
/// newest. `name` begins messages. Fails without files, and if two of them are of one instant. thread: any
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_dated_files(const std::string& name,
                                                                   const std::vector<DatedFile>& files,
                                                                   const std::string& time, OpenDatedFile open);

/// Opens the files of several times beside a cache (file_of_time()) as open_dated_files() does. Sends no request.
/// nullptr if there are no such files. thread: any
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_dated_caches(const std::filesystem::path& cache,
                                                                    const std::string& time);

}  // namespace terrella
