#include "apps/open_scene/dated_caches.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/open_scene/open_cache.h"
#include "apps/open_scene/passed_tiles.h"
#include "base/time_steps.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

Result<std::unique_ptr<TileSource>> open_step(const fs::path& cache, const std::shared_ptr<const TimeSteps>& steps,
                                              UtcTime time);

/// The cache of one time, with the times of those beside it.
class DatedCache : public PassedTiles {
 public:
  DatedCache(std::unique_ptr<TileSource> tiles, TileSetInfo info, fs::path cache)
      : PassedTiles(std::move(tiles), std::move(info)), cache_(std::move(cache)) {}
  [[nodiscard]] Result<std::unique_ptr<TileSource>> at_time(UtcTime time) override {
    return open_step(cache_, info().steps, time);
  }

 private:
  fs::path cache_;
};

Result<std::unique_ptr<TileSource>> open_step(const fs::path& cache, const std::shared_ptr<const TimeSteps>& steps,
                                              UtcTime time) {
  const auto step = steps->at_or_before(time);
  if (!step) {
    return Error{fmt::format("{}: no file beside it is of {} or earlier; the first time is {}", cache.string(),
                             time_text(time, TimePrecision::second, true), steps->text(steps->first()))};
  }
  const std::string text = steps->text(*step);
  auto tiles = open_tile_set(file_of_time(cache, text));
  if (!tiles) return tiles.error();
  TileSetInfo info = (*tiles)->info();
  info.time = text;
  info.times = steps->summary();
  info.instant = step;
  info.steps = steps;
  return std::unique_ptr<TileSource>(std::make_unique<DatedCache>(*std::move(tiles), std::move(info), cache));
}

/// The time in the name of a file beside a cache; empty if it has none.
std::string time_in_name(const fs::path& file, const fs::path& cache) {
  const std::string name = file.filename().string();
  const std::string before = cache.stem().string() + ".", after = cache.extension().string();
  if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after)) return {};
  std::string time = name.substr(before.size(), name.size() - before.size() - after.size());
  // A name has no colons.
  const std::size_t clock = std::min(time.find('T'), time.size());
  std::replace(time.begin() + static_cast<std::ptrdiff_t>(clock), time.end(), '-', ':');
  return read_named_time(time) ? time : std::string();
}

}  // namespace

Result<std::shared_ptr<TileSource>> open_dated_caches(const fs::path& cache, const std::string& time) {
  std::vector<std::string> times;
  std::error_code failed;
  const fs::path folder = cache.has_parent_path() ? cache.parent_path() : fs::path(".");
  for (fs::directory_iterator file(folder, failed), end; !failed && file != end; file.increment(failed)) {
    std::string found = time_in_name(file->path(), cache);
    if (!found.empty()) times.push_back(std::move(found));
  }
  if (times.empty()) return std::shared_ptr<TileSource>();
  Result<TimeSteps> read = TimeSteps::parse(times, UtcTime());
  if (!read) return read.error();
  const auto steps = std::make_shared<const TimeSteps>(*std::move(read));
  const auto wanted = read_named_time(time);
  auto tiles = open_step(cache, steps, wanted ? wanted->from : steps->last());
  if (!tiles) return tiles.error();
  return std::shared_ptr<TileSource>(*std::move(tiles));
}

}  // namespace terrella
